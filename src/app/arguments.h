// Arguments of a program that is run: this one, anew or beside the window.
#pragma once
#include "app/device_options.h"
#include "roil.h"

typedef struct arguments {
    char **list; // ends with NULL
    size_t count, capacity;
} arguments;

void arguments_add(arguments *a, const char *text);
void arguments_add_number(arguments *a, double number);
void arguments_add_moved(arguments *a, roil_effect *e); // "--set NAME=VALUE" of all that was moved
void arguments_add_device(arguments *a, const app_device *d);
void arguments_free(arguments *a);
