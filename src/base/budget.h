// Budgets of memory: how much is taken, for what, and how much may be taken.
//
// There is a budget for each kind of memory: the host's, one for the process, and one for each
// device with memory of its own. Memory whose size a file decides is taken from a budget, under a
// label, before it is allocated. Beyond a share of what the machine has it is refused, with a
// message that names the sum and its three largest parts. Parts with the same label count as one
// there. Any thread may call these functions.
#pragma once
#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct budget budget;
typedef struct budget_part budget_part;

enum { BUDGET_LABEL = 64, BUDGET_LARGEST = 3 };

typedef struct budget_row { // the bytes taken under one label
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
// Returns whether it is asked for the first time about this object, so that what is shared counts
// once.
bool budget_list_first(budget_list *list, const void *owner);
void budget_list_free(budget_list *list); // empty afterwards

// Sets what may be taken of each budget of the process from now on: "60%" of what there is of it,
// or an amount as "8G" or "512M". NULL: 60 %. False with a message when it is none of these.
bool budget_set_share(const char *text);

// Returns the host's budget: the memory of the machine, or less where the process's control group
// or address space is limited.
budget *budget_host(void);
// Creates a budget of `total` bytes. `name` appears in messages: "device memory".
budget *budget_create(const char *name, uint64_t total);
// Creates a budget of `limit` bytes whose parts are taken from `parent`, too, so that neither limit
// is passed. `setting` appears in messages: who sets another limit.
budget *budget_create_within(budget *parent, const char *name, uint64_t limit, const char *setting);
// Reads an amount, as "512M" or "8G". False with a message.
bool budget_read_amount(const char *text, uint64_t *bytes);
void budget_destroy(budget *b); // its parts must be given back before; NULL is allowed

// Takes bytes from a budget. NULL with a message, and nothing is taken, when they are too many.
// `label` is copied.
budget_part *budget_take(budget *b, uint64_t bytes, const char *label);
void budget_give(budget_part *part); // gives a part back; NULL is allowed
// Changes the size of a part. False with a message, and the part is unchanged.
bool budget_resize(budget_part *part, uint64_t bytes);
// Adds memory that is taken already and cannot be refused, such as many small objects.
void budget_note(budget_part *part, uint64_t bytes);
// Moves bytes between two parts of the same budget. The sum does not change.
void budget_move(budget_part *from, budget_part *to, uint64_t bytes);

// Returns whether all rows could be taken after `freed` bytes were given back. For plans whose
// parts are taken one by one. False with the message of a refusal.
bool budget_ask(budget *b, const budget_row *rows, size_t count, uint64_t freed);
// Raises the limit by so many bytes, at most to nine tenths of the memory that exists, while an old
// and a new state exist side by side. 0 ends it.
void budget_lend(budget *b, uint64_t bytes);
uint64_t budget_room(budget *b); // bytes that could be taken now
uint64_t budget_get_limit(budget *b);

typedef struct budget_state {
    uint64_t sum, limit, total;
    budget_row largest[BUDGET_LARGEST]; // bytes 0: there are fewer
} budget_state;
budget_state budget_get(budget *b);
