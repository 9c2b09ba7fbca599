// Pictures rendered out of the window: what is asked for waits in a queue, and runs beside the
// window as `roil render` in a process of its own, one after the other.
#pragma once
#include "app/live.h"

render_queue *render_queue_create(void);
void render_queue_destroy(render_queue *q); // stops what runs
void render_queue_open(live *l);            // opens the window in which a rendering is asked for
bool render_queue_close(live *l);           // false: it was not open
void render_queue_update(live *l);          // reads what runs has said, starts the next
bool render_queue_runs(const live *l);
void render_queue_draw(live *l);
