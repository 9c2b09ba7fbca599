// Monotonic time. Any thread.
#pragma once
double clock_seconds(void); // seconds since an arbitrary start, in steps of a nanosecond
