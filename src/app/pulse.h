// How alive the window is: how often it is drawn, and how soon it answers a hand.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PULSE_ANSWERS = 1024, PULSE_SHOWN = 64 };
typedef struct pulse {
    uint64_t shown;                // pictures of the window
    double times[PULSE_SHOWN];     // clock_seconds of the last ones
    double busy_seconds;           // while a frame or a simulation was at work, ...
    uint64_t busy_shown;           // ... and pictures then
    double asked;                  // clock_seconds of the first input without an answer; 0: none
    double answers[PULSE_ANSWERS]; // seconds from an input to the picture that answers it
    uint64_t answered;             // of these the last are kept
} pulse;

void pulse_ask(pulse *p, double when); // there was input, no sooner than that
// `busy`: a frame or a simulation is at work. Of each turn, and of each picture that was shown.
void pulse_turn(pulse *p, double seconds, bool busy);
void pulse_show(pulse *p, double now, bool busy);
double pulse_rate(const pulse *p, double now); // pictures a second, of late

typedef struct pulse_answers { // milliseconds from an input to its answer
    double median, p95, longest;
    size_t count;
} pulse_answers;
pulse_answers pulse_summarise(const pulse *p);
// Writes all as JSON, with the frames of the effect that were drawn. False with a message.
bool pulse_save(const pulse *p, const char *file, uint64_t drawn);
