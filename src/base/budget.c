#include "base/budget.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/swap.h"
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

struct budget_part {
    budget *owner;
    budget_part *above; // of the owner's parent; NULL: there is none
    char label[BUDGET_LABEL];
    uint64_t bytes;
    budget_part *previous, *next;
};

struct budget {
    pthread_mutex_t lock;
    const char *name;
    uint64_t total, sum, lent;
    budget *parent;      // NULL: none
    const char *setting; // that limits it to `total`; NULL: the share of the process does
    budget_part *first;
};

static const double DEFAULT_SHARE = 0.6;
enum { LARGE = 1 << 20 }; // bytes

// The share that may be taken: bytes, or a percentage where they are 0. Guarded by `share_lock`.
static pthread_mutex_t share_lock = PTHREAD_MUTEX_INITIALIZER;
static double share = DEFAULT_SHARE;
static uint64_t share_bytes;

// ---- how much there is ------------------------------------------------------------------------

static void lower(uint64_t *limit, uint64_t to) {
    if (to > 0 && to < *limit) *limit = to;
}

static void lower_by_file(uint64_t *limit, const char *path) {
    unsigned long long bytes;
    FILE *f = fopen(path, "re");
    if (!f) return;
    if (fscanf(f, "%llu", &bytes) == 1) lower(limit, bytes); // "max" is none
    fclose(f);
}

// Lowers the limit to that of the process's control group and of all groups above it. Inside of a
// container the process's own group is the root of what is visible.
static void lower_by_groups(uint64_t *limit) {
    char line[512], path[640];
    FILE *f = fopen("/proc/self/cgroup", "re");
    while (f && fgets(line, sizeof line, f)) {
        if (strncmp(line, "0::", 3) != 0) continue;
        line[strcspn(line, "\n")] = '\0';
        char *group = line + 3;
        for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
            *end = '\0';
            snprintf(path, sizeof path, "/sys/fs/cgroup%s/memory.max", group);
            lower_by_file(limit, path);
        }
    }
    if (f) fclose(f);
    lower_by_file(limit, "/sys/fs/cgroup/memory.max");
    lower_by_file(limit, "/sys/fs/cgroup/memory/memory.limit_in_bytes"); // the first version
}

static uint64_t host_total(void) {
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    uint64_t total = pages > 0 && size > 0 ? (uint64_t)pages * (uint64_t)size : UINT64_MAX;
    struct rlimit space;
    lower_by_groups(&total);
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
        lower(&total, space.rlim_cur);
    return total;
}

static budget host = {.lock = PTHREAD_MUTEX_INITIALIZER, .name = "memory"};

static void measure_host(void) {
    host.total = host_total();
}

budget *budget_host(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, measure_host);
    return &host;
}

budget *budget_create(const char *name, uint64_t total) {
    budget *b = mem_alloc(sizeof *b);
    b->name = name;
    b->total = total;
    pthread_mutex_init(&b->lock, NULL);
    return b;
}

budget *budget_create_within(budget *parent, const char *name, uint64_t limit,
                             const char *setting) {
    budget *b = budget_create(name, limit);
    b->parent = parent;
    b->setting = setting;
    return b;
}

void budget_destroy(budget *b) {
    if (!b || b == &host) return;
    pthread_mutex_destroy(&b->lock);
    mem_free(b);
}

// ---- how much may be taken --------------------------------------------------------------------

static bool read_share(const char *text, double *out_share, uint64_t *out_bytes) {
    char *end;
    double value = str_double(text, &end);
    if (end == text || !isfinite(value) || value <= 0) return false;
    *out_share = 0;
    *out_bytes = 0;
    if (strcmp(end, "%") == 0) {
        *out_share = value / 100;
        return value <= 100;
    }
    static const char units[] = "KMGT";
    const char *unit = *end ? strchr(units, *end & ~0x20) : NULL;
    if (!unit || (end[1] && strcmp(end + 1, "iB") != 0 && strcmp(end + 1, "B") != 0)) return false;
    value = ldexp(value, 10 * (int)(unit - units + 1));
    if (value < (1 << 20) || value > 0x1p60) return false;
    *out_bytes = (uint64_t)value;
    return true;
}

bool budget_read_amount(const char *text, uint64_t *bytes) {
    double none;
    return (read_share(text, &none, bytes) && *bytes) ||
           err_set("an amount of memory '%s'; accepted: from 1M, as 512M or 8G", text);
}

bool budget_set_share(const char *text) {
    double of_all = DEFAULT_SHARE;
    uint64_t bytes = 0;
    if (text && !read_share(text, &of_all, &bytes))
        return err_set("memory '%s'; accepted: a share of what the machine has, as 80%%, up to "
                       "100%%, or an amount from 1M, as 512M or 8G",
                       text);
    pthread_mutex_lock(&share_lock);
    share = of_all;
    share_bytes = bytes;
    pthread_mutex_unlock(&share_lock);
    return true;
}

static uint64_t limit_without_loan(const budget *b) {
    if (b->setting) return b->total;
    pthread_mutex_lock(&share_lock);
    uint64_t limit = share_bytes ? share_bytes : (uint64_t)((double)b->total * share);
    pthread_mutex_unlock(&share_lock);
    return limit;
}

static uint64_t limit_of(const budget *b) { // under its lock
    uint64_t limit = limit_without_loan(b), most = b->total / 10 * 9;
    if (b->lent == 0 || limit >= most) return limit;
    return b->lent < most - limit ? limit + b->lent : most;
}

// ---- the largest parts ------------------------------------------------------------------------

static int by_label(const void *a, const void *b) {
    return strcmp(((const budget_row *)a)->label, ((const budget_row *)b)->label);
}

static uint64_t plus(uint64_t a, uint64_t b) { // at most the largest number
    return a < UINT64_MAX - b ? a + b : UINT64_MAX;
}

static void put_in_order(budget_row largest[BUDGET_LARGEST], budget_row row) {
    for (size_t i = 0; i < BUDGET_LARGEST; i++) {
        if (row.bytes <= largest[i].bytes) continue;
        SWAP(largest[i], row);
    }
}

// Finds the largest of the existing parts and the requested ones. Call it under the lock.
static void find_largest(const budget *b, const budget_row *asked, size_t count,
                         budget_row largest[BUDGET_LARGEST]) {
    size_t all = count;
    for (const budget_part *p = b->first; p; p = p->next) all++;
    budget_row *rows = mem_alloc(all * sizeof *rows), *next = rows;
    for (size_t i = 0; i < count; i++) *next++ = asked[i];
    for (const budget_part *p = b->first; p; p = p->next, next++) {
        memcpy(next->label, p->label, sizeof next->label);
        next->bytes = p->bytes;
    }
    qsort(rows, all, sizeof *rows, by_label);
    memset(largest, 0, BUDGET_LARGEST * sizeof *largest);
    for (size_t i = 0; i < all;) {
        budget_row sum = rows[i++];
        for (; i < all && strcmp(rows[i].label, sum.label) == 0; i++)
            sum.bytes = plus(sum.bytes, rows[i].bytes);
        put_in_order(largest, sum);
    }
    mem_free(rows);
}

static void add_amount(strbuf *out, uint64_t bytes) {
    strbuf_add(out, "%.1f MiB", (double)bytes / (1 << 20));
}

// Sets the message of a refusal. Call it under the lock. Always returns false.
static bool budget_refuse(const budget *b, const budget_row *rows, size_t count, uint64_t sum) {
    budget_row largest[BUDGET_LARGEST];
    find_largest(b, rows, count, largest);
    strbuf text = {0};
    if (count == 1) strbuf_add(&text, "%s: ", rows[0].label);
    add_amount(&text, sum);
    strbuf_add(&text, " of %s would be taken in all, and ", b->name);
    add_amount(&text, limit_of(b));
    if (b->setting) {
        strbuf_add(&text, " may be (%s sets another limit); the largest parts:", b->setting);
    } else {
        strbuf_add(&text, " may be, of ");
        add_amount(&text, b->total);
        strbuf_add(&text, " (--memory 80%% or --memory 8G, or `memory` of roil_desc, sets another "
                          "limit); the largest parts:");
    }
    for (size_t i = 0; i < BUDGET_LARGEST && largest[i].bytes > 0; i++) {
        strbuf_add(&text, "%s %s ", i ? "," : "", largest[i].label);
        add_amount(&text, largest[i].bytes);
    }
    err_set("%s", strbuf_text(&text));
    strbuf_free(&text);
    return false;
}

static bool is_free(const budget *b, uint64_t bytes) { // under the lock
    uint64_t limit = limit_of(b);
    return b->sum <= limit && bytes <= limit - b->sum;
}

// ---- parts ------------------------------------------------------------------------------------

// Returns whether the heap has as much. What is small is never asked for: there is a reserve.
static bool heap_has(const budget *b, uint64_t bytes, const char *label) {
    if (b != &host || bytes < LARGE) return true;
    void *block = bytes <= SIZE_MAX ? mem_try(NULL, (size_t)bytes) : NULL;
    mem_free(block);
    if (block) return true;
    err_no_memory((size_t)bytes);
    return err_prefix("%s: ", label);
}

budget_part *budget_take(budget *b, uint64_t bytes, const char *label) {
    budget_row row = {.bytes = bytes};
    budget_part *above = b->parent ? budget_take(b->parent, bytes, label) : NULL;
    if (b->parent && !above) return NULL;
    str_copy(row.label, sizeof row.label, label);
    if (!heap_has(b, bytes, label)) return NULL;
    pthread_mutex_lock(&b->lock);
    // Nothing can be had of no bytes, so that a part of them is only a name.
    bool done = bytes == 0 || is_free(b, bytes) || budget_refuse(b, &row, 1, plus(b->sum, bytes));
    budget_part *part = NULL;
    if (done) {
        part = mem_alloc(sizeof *part);
        *part = (budget_part){.owner = b, .above = above, .bytes = bytes, .next = b->first};
        memcpy(part->label, row.label, sizeof part->label);
        if (b->first) b->first->previous = part;
        b->first = part;
        b->sum += bytes;
    }
    pthread_mutex_unlock(&b->lock);
    if (!part) budget_give(above);
    return part;
}

void budget_give(budget_part *part) {
    if (!part) return;
    budget *b = part->owner;
    pthread_mutex_lock(&b->lock);
    b->sum -= part->bytes;
    if (part->next) part->next->previous = part->previous;
    if (part->previous)
        part->previous->next = part->next;
    else
        b->first = part->next;
    pthread_mutex_unlock(&b->lock);
    budget_give(part->above);
    mem_free(part);
}

bool budget_resize(budget_part *part, uint64_t bytes) {
    budget *b = part->owner;
    const uint64_t before = part->bytes;
    if (part->above && !budget_resize(part->above, bytes)) return false;
    pthread_mutex_lock(&b->lock);
    uint64_t more = bytes > part->bytes ? bytes - part->bytes : 0;
    bool done = more == 0 || is_free(b, more);
    if (done) {
        b->sum += bytes - part->bytes;
        part->bytes = bytes;
    } else {
        budget_row row = {.bytes = more};
        memcpy(row.label, part->label, sizeof row.label);
        budget_refuse(b, &row, 1, plus(b->sum, more));
    }
    pthread_mutex_unlock(&b->lock);
    if (!done && part->above) budget_resize(part->above, before); // less than it has
    return done;
}

void budget_note(budget_part *part, uint64_t bytes) {
    pthread_mutex_lock(&part->owner->lock);
    part->owner->sum += bytes - part->bytes;
    part->bytes = bytes;
    pthread_mutex_unlock(&part->owner->lock);
    if (part->above) budget_note(part->above, bytes);
}

void budget_move(budget_part *from, budget_part *to, uint64_t bytes) {
    pthread_mutex_lock(&from->owner->lock);
    from->bytes -= bytes;
    to->bytes += bytes;
    pthread_mutex_unlock(&from->owner->lock);
    if (from->above && to->above) budget_move(from->above, to->above, bytes);
}

// ---- lists ------------------------------------------------------------------------------------

void budget_list_add(budget_list *list, const char *label, uint64_t bytes) {
    if (bytes == 0) return;
    budget_row *row = MEM_ADD(list->rows, list->count, list->capacity);
    *row = (budget_row){.bytes = bytes};
    str_copy(row->label, sizeof row->label, label);
}

bool budget_list_first(budget_list *list, const void *owner) {
    for (size_t i = 0; i < list->owner_count; i++)
        if (list->owners[i] == owner) return false;
    *MEM_ADD(list->owners, list->owner_count, list->owner_capacity) = owner;
    return true;
}

void budget_list_free(budget_list *list) {
    mem_free(list->rows);
    mem_free(list->owners);
    *list = (budget_list){0};
}

// ---- questions --------------------------------------------------------------------------------

bool budget_ask(budget *b, const budget_row *rows, size_t count, uint64_t freed) {
    pthread_mutex_lock(&b->lock);
    uint64_t sum = b->sum > freed ? b->sum - freed : 0;
    for (size_t i = 0; i < count; i++) sum = plus(sum, rows[i].bytes);
    bool done = sum <= limit_of(b) || sum <= b->sum || budget_refuse(b, rows, count, sum);
    pthread_mutex_unlock(&b->lock);
    return done && (!b->parent || budget_ask(b->parent, rows, count, freed));
}

void budget_lend(budget *b, uint64_t bytes) {
    pthread_mutex_lock(&b->lock);
    b->lent = bytes;
    pthread_mutex_unlock(&b->lock);
    if (b->parent) budget_lend(b->parent, bytes);
}

static void lower_to(uint64_t *value, uint64_t most) {
    if (most < *value) *value = most;
}

uint64_t budget_room(budget *b) {
    pthread_mutex_lock(&b->lock);
    uint64_t limit = limit_of(b), room = limit > b->sum ? limit - b->sum : 0;
    pthread_mutex_unlock(&b->lock);
    if (b->parent) lower_to(&room, budget_room(b->parent));
    return room;
}

uint64_t budget_get_limit(budget *b) {
    pthread_mutex_lock(&b->lock);
    uint64_t limit = limit_of(b);
    pthread_mutex_unlock(&b->lock);
    if (b->parent) lower_to(&limit, budget_get_limit(b->parent));
    return limit;
}

budget_state budget_get(budget *b) {
    pthread_mutex_lock(&b->lock);
    budget_state state = {.sum = b->sum, .limit = limit_of(b), .total = b->total};
    find_largest(b, NULL, 0, state.largest);
    pthread_mutex_unlock(&b->lock);
    return state;
}
