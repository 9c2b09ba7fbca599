// One account of memory: what is taken of the machine, by whom, and how much may be.
//
// A budget is a kind of memory: the host's, of which a process has one, and that of a device with
// memory of its own. What a file can ask for in size is taken here before it is allocated, under a
// label; beyond a share of the machine it is refused with the sum and its three largest parts.
// Parts of the same label count as one there. Any thread may call all of this.
#pragma once
#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct budget budget;
typedef struct budget_part budget_part;

enum { BUDGET_LABEL = 64, BUDGET_LARGEST = 3 };

typedef struct budget_row { // one label
    char label[BUDGET_LABEL];
    uint64_t bytes;
} budget_row;

typedef struct budget_list { // zero: empty
    budget_row *rows;        // mem_free, by budget_list_free
    size_t count, capacity;
    const void **owners; // that were asked about
    size_t owner_count, owner_capacity;
} budget_list;

void budget_list_add(budget_list *list, const char *label, uint64_t bytes); // `label` is copied
// Whether it is asked for the first time about this object, so that what is shared counts once.
bool budget_list_first(budget_list *list, const void *owner);
void budget_list_free(budget_list *list); // empty afterwards

// What may be taken of each budget: "60%" of what there is of it, or an amount as "8G" or "512M".
// NULL: 60 %. Of the whole process, from now on; false with a message when it is none of these.
bool budget_set_share(const char *text);

// The host's: as much as the machine has, or what its control group and address space allow.
budget *budget_host(void);
budget *budget_create(const char *name, uint64_t total); // "device memory"; bytes that there are
void budget_destroy(budget *b);                          // after its parts; NULL is fine

// NULL with a message; nothing is taken then. `label` is copied.
budget_part *budget_take(budget *b, uint64_t bytes, const char *label);
void budget_give(budget_part *part); // NULL is fine
// To another size; false with a message, and it is as it was.
bool budget_resize(budget_part *part, uint64_t bytes);
// What is taken already and cannot be refused any more, such as many small objects.
void budget_note(budget_part *part, uint64_t bytes);
// From one part to another of the same budget: the sum stays as it is.
void budget_move(budget_part *from, budget_part *to, uint64_t bytes);

// Whether all rows could be taken, if `freed` bytes were given before: for what is known as a whole
// before its first part is. False with the message of a refusal.
bool budget_ask(budget *b, const budget_row *rows, size_t count, uint64_t freed);
// For a while the limit is so much higher, but not above nine tenths of what there is: two states
// live at once, one of which is about to go. 0 ends it.
void budget_lend(budget *b, uint64_t bytes);
uint64_t budget_room(budget *b); // bytes that could be taken now
uint64_t budget_get_limit(budget *b);

typedef struct budget_state {
    uint64_t sum, limit, total;
    budget_row largest[BUDGET_LARGEST]; // bytes 0: there are no more
} budget_state;
budget_state budget_get(budget *b);
