// Textures of the frames shown lately and of those to come.
//
// A sequence whose frames all fit into a budget stays on the device once it was shown. Of others a
// few frames are kept: those on show and those ahead, since a frame that was shown is the last to
// be wanted again. The least recently used textures make room.
//
// A frame that is wanted now is taken from the textures, else from the job that has begun it, else
// decoded here (sequence_cache_get); or the nearest that is there is shown in its place
// (sequence_cache_nearest).
#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "field/sequence_parts.h"
#include "gpu/profile.h"
#include <assert.h>
#include <string.h>

enum {
    MOST_SLOTS = 4096,
    SHOWN = 4,        // frames on show, and those that frames in flight may still show
    UPLOAD_AHEAD = 3, // frames brought to the device before their time
};

static void start(sequence_data *s, gpu *g) {
    sequence_cache *c = &s->cache;
    c->budget = gpu_get_profile(g)->sequence_bytes;
    c->slot_count = s->frame_count < MOST_SLOTS ? s->frame_count : MOST_SLOTS;
    if (c->slot_count < SHOWN + UPLOAD_AHEAD) c->slot_count = SHOWN + UPLOAD_AHEAD;
    c->slots = mem_alloc(c->slot_count * sizeof *c->slots);
    sequence_jobs_start(s);
}

// ---- slots ------------------------------------------------------------------------------------

static bool is_ready(const sequence_slot *slot) {
    return slot->used > 0 && !slot->filling;
}

static sequence_slot *find_slot(sequence_cache *c, uint32_t frame) {
    for (size_t i = 0; i < c->slot_count; i++)
        if (is_ready(&c->slots[i]) && c->slots[i].frame == frame) return &c->slots[i];
    return NULL;
}

static void count_bytes(sequence_data *s) {
    sequence_cache *c = &s->cache;
    c->counts.device_bytes = 0;
    for (size_t i = 0; i < c->slot_count; i++) c->counts.device_bytes += c->slots[i].bytes;
}

bool sequence_may_prepare(gpu *g, uint64_t bytes) {
    budget *b = g ? gpu_get_budget(g) : budget_host();
    uint64_t room = budget_room(b), left = budget_get_limit(b) / 4;
    return room > left && bytes <= room - left;
}

static bool all_fit(const sequence_data *s) {
    return s->cache.counts.largest_bytes * s->frame_count <= s->cache.budget;
}

typedef struct slots_use {
    size_t count;                   // in use
    sequence_slot *unused, *oldest; // the latter neither on show nor being filled
} slots_use;

static slots_use look_at_slots(sequence_cache *c) {
    slots_use use = {0};
    for (size_t i = 0; i < c->slot_count; i++) {
        sequence_slot *slot = &c->slots[i];
        if (slot->used == 0) {
            if (!use.unused) use.unused = slot;
            continue;
        }
        use.count++;
        if (slot->filling || slot->used == c->turn) continue;
        if (!use.oldest || slot->used < use.oldest->used) use.oldest = slot;
    }
    return use;
}

// A slot for one more frame of so many bytes: an unused one while the budget lasts, else the least
// recently used. There is one: each slot holds another frame, and there are as many slots as
// frames.
static sequence_slot *take_slot(sequence_data *s, gpu *g, uint64_t bytes) {
    const size_t few = SHOWN + UPLOAD_AHEAD;
    sequence_cache *c = &s->cache;
    if (bytes > c->counts.largest_bytes) c->counts.largest_bytes = bytes;
    slots_use use = look_at_slots(c);
    bool wanted = use.unused && (all_fit(s) || use.count < few);
    bool room = sequence_may_prepare(g, bytes);
    if (wanted && !room && !c->limited) {
        c->limited = true;
        log_write(
            LOG_INFO,
            "%s: memory is there for %zu frames on the device; others are brought there again "
            "when they are shown",
            s->name, use.count);
    }
    if (use.unused && ((room && wanted) || !use.oldest)) return use.unused;
    while (!all_fit(s) && use.count > few && use.oldest) { // kept while smaller ones would have fit
        sequence_slot *freed = use.oldest;
        sequence_slot_free(freed, g);
        use = look_at_slots(c);
        if (!use.oldest) return freed;
    }
    assert(use.oldest);
    return use.oldest;
}

// ---- uploads ----------------------------------------------------------------------------------

// Memory to copy from, which is dear to make: if it must be, for the largest frame to come.
static gpu_transfer *take_transfer(sequence_data *s, gpu *g, uint32_t frame, uint64_t size) {
    sequence_cache *c = &s->cache;
    double largest = (double)size * (double)sequence_growth(s, frame);
    for (size_t i = 0; i < SEQUENCE_TRANSFERS; i++) {
        gpu_transfer *t = c->idle[i];
        if (!t || !gpu_transfer_done(g, t)) continue;
        c->idle[i] = NULL;
        if (gpu_transfer_size(t) >= size) return t;
        gpu_transfer_destroy(g, t);
    }
    if (!all_fit(s) && largest < (double)s->desc.max_frame_bytes) size = (uint64_t)largest;
    gpu_transfer *made = gpu_transfer_create(g, size);
    if (!made) err_prefix("%s: ", s->name);
    return made;
}

static void give_transfer(sequence_data *s, gpu *g, gpu_transfer *t) {
    for (size_t i = 0; i < SEQUENCE_TRANSFERS; i++)
        if (!s->cache.idle[i]) {
            s->cache.idle[i] = t;
            return;
        }
    gpu_transfer_destroy(g, t);
}

static void warn(sequence_data *s, uint32_t frame, uint64_t bad) {
    if (bad == 0 || s->cache.warned) return;
    s->cache.warned = true;
    log_write(LOG_WARNING, "%s: %llu values of frame %u are not finite; they count as 0", s->name,
              (unsigned long long)bad, frame + 1);
}

static void note_decoded(sequence_data *s, uint32_t frame, const sequence_texels *texels,
                         double seconds) {
    field_playback *counts = &s->cache.counts;
    counts->decoded++;
    counts->decoded_bytes += sequence_upload_bytes(s, texels);
    counts->decode_seconds += seconds;
    if (texels->voxels > counts->largest_voxels) counts->largest_voxels = texels->voxels;
    warn(s, frame, texels->bad);
}

// A slot with textures for these texels, and memory to copy from. False with a message.
static bool prepare(sequence_data *s, gpu *g, uint32_t frame, const sequence_texels *texels,
                    sequence_slot **slot, gpu_transfer **transfer) {
    uint64_t size = sequence_upload_bytes(s, texels);
    *slot = take_slot(s, g, size);
    (*slot)->used = 0; // in case it fails half-way
    for (int i = 0; i < FIELD_GRID_IMAGES; i++)
        if (texels->bricks[i].layers > s->cache.layers[i])
            s->cache.layers[i] = texels->bricks[i].layers;
    bool ok = sequence_slot_fit(s, g, texels, !all_fit(s), *slot);
    count_bytes(s);
    if (ok) *transfer = take_transfer(s, g, frame, size);
    return ok && *transfer;
}

static bool begin_copy(sequence_data *s, gpu *g, const sequence_texels *texels,
                       const sequence_slot *slot, gpu_transfer *transfer) {
    gpu_transfer_part parts[2 * FIELD_GRID_IMAGES];
    size_t count = sequence_upload_parts(s, texels, slot, parts);
    s->cache.counts.uploaded++;
    s->cache.counts.uploaded_bytes += sequence_upload_bytes(s, texels);
    return gpu_transfer_start(g, transfer, parts, count) || err_prefix("%s: ", s->name);
}

static void fill(sequence_data *s, sequence_slot *slot, uint32_t frame,
                 const sequence_texels *texels) {
    slot->frame = frame;
    slot->active = texels->active;
    slot->used = s->cache.turn;
}

// Decoded texels onto the device, at once.
static sequence_slot *upload(sequence_data *s, gpu *g, uint32_t frame,
                             const sequence_texels *texels) {
    sequence_slot *slot;
    gpu_transfer *t = NULL;
    if (!prepare(s, g, frame, texels, &slot, &t)) return NULL;
    sequence_upload_write(s, texels, gpu_transfer_map(t));
    bool ok = begin_copy(s, g, texels, slot, t) && gpu_transfer_finish(g, t);
    give_transfer(s, g, t);
    if (!ok) return NULL;
    fill(s, slot, frame, texels);
    return slot;
}

// ---- jobs -------------------------------------------------------------------------------------

// The next thing to do with a job that no thread has. False with a message.
static bool move_on(sequence_data *s, gpu *g, sequence_job *job, int state) {
    if (state == JOB_DECODED) {
        note_decoded(s, job->frame, &job->texels, job->seconds);
        if (!prepare(s, g, job->frame, &job->texels, &job->slot, &job->transfer)) return false;
        fill(s, job->slot, job->frame, &job->texels);
        job->slot->filling = true;
        sequence_job_stage(job);
        return true;
    }
    job->state = JOB_COPYING;
    return begin_copy(s, g, &job->texels, job->slot, job->transfer);
}

static void forget(sequence_data *s, gpu *g, sequence_job *job, bool usable) {
    if (job->slot) job->slot->filling = false;
    if (job->slot && !usable) job->slot->used = 0;
    if (job->transfer) give_transfer(s, g, job->transfer);
    sequence_job_drop(s, job);
}

// Brings a job to its end, whatever it waits for; NULL with a message.
static sequence_slot *complete(sequence_data *s, gpu *g, sequence_job *job) {
    int state = sequence_job_wait(job);
    bool ok = job->ok || err_set("%s", job->message);
    while (ok && state != JOB_COPYING) {
        ok = move_on(s, g, job, state);
        state = sequence_job_wait(job);
    }
    ok = ok && (gpu_transfer_finish(g, job->transfer) || err_prefix("%s: ", s->name));
    sequence_slot *slot = job->slot;
    forget(s, g, job, ok);
    return ok ? slot : NULL;
}

// The same for what can be done without waiting. Errors wait for the frame to be wanted.
static void step(sequence_data *s, gpu *g, sequence_job *job, bool *busy) {
    int state = sequence_job_state(job);
    if (!job->ok && state == JOB_DECODED) return;
    if (state == JOB_COPYING) {
        if (!gpu_transfer_done(g, job->transfer)) return;
        forget(s, g, job, gpu_transfer_finish(g, job->transfer));
        return;
    }
    if (state != JOB_DECODED && state != JOB_STAGED) return;
    if (state == JOB_STAGED && *busy) return;
    bool room = sequence_may_prepare(g, sequence_upload_bytes(s, &job->texels));
    if (state == JOB_DECODED && !room && !look_at_slots(&s->cache).oldest) return;
    *busy = *busy || state == JOB_STAGED;
    if (move_on(s, g, job, state)) return;
    log_write(LOG_WARNING, "%s", err_get());
    job->state = JOB_DECODED;
    forget(s, g, job, false);
}

void sequence_cache_pump(sequence_data *s, gpu *g) {
    sequence_jobs *j = &s->cache.jobs;
    bool busy = false; // one copy a frame, so that none takes long
    for (size_t k = 0; k < j->wanted_count; k++) {
        sequence_job *job = sequence_job_find(s, j->wanted[k]);
        bool soon = k < UPLOAD_AHEAD || (job && sequence_job_state(job) != JOB_DECODED);
        if (job && soon) step(s, g, job, &busy);
    }
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++) { // late ones may still be the nearest
        sequence_job *job = j->list[i];
        bool wanted = false;
        for (size_t k = 0; job && k < j->wanted_count; k++)
            wanted = wanted || j->wanted[k] == job->frame;
        if (job && !wanted) step(s, g, job, &busy);
    }
}

void sequence_cache_ahead(sequence_data *s, const uint32_t *frames, size_t count) {
    sequence_jobs *j = &s->cache.jobs;
    memcpy(j->wanted, frames, count * sizeof *frames);
    j->wanted_count = count;
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++) {
        sequence_job *job = j->list[i];
        bool wanted = false;
        for (size_t k = 0; job && k < count; k++) wanted = wanted || job->frame == frames[k];
        int state = job && !wanted ? sequence_job_state(job) : JOB_STAGED;
        if (state == JOB_QUEUED || (state == JOB_DECODED && !job->ok)) sequence_job_drop(s, job);
    }
    for (size_t k = 0; k < count; k++)
        if (!sequence_job_find(s, frames[k]) && !find_slot(&s->cache, frames[k]) &&
            !sequence_job_add(s, frames[k]))
            return;
}

// ---- frames -----------------------------------------------------------------------------------

static sequence_slot *show(sequence_data *s, sequence_slot *slot) {
    if (slot) slot->used = s->cache.turn;
    return slot;
}

sequence_slot *sequence_cache_get(sequence_data *s, gpu *g, uint32_t frame) {
    sequence_cache *c = &s->cache;
    if (c->slot_count == 0) start(s, g);
    sequence_slot *slot = find_slot(c, frame);
    if (slot) return show(s, slot);
    sequence_job *job = sequence_job_find(s, frame);
    // One that still waits for a thread is decoded sooner here.
    bool queued = job && sequence_job_state(job) == JOB_QUEUED && sequence_job_drop(s, job);
    if (job && !queued) return show(s, complete(s, g, job));
    sequence_texels texels;
    double begin = clock_seconds();
    if (!sequence_decode(s, frame, &texels)) return NULL;
    note_decoded(s, frame, &texels, clock_seconds() - begin);
    slot = upload(s, g, frame, &texels);
    sequence_texels_free(&texels);
    return show(s, slot);
}

sequence_slot *sequence_cache_nearest(sequence_data *s, uint32_t frame) {
    sequence_cache *c = &s->cache;
    sequence_slot *best = NULL;
    uint32_t least = UINT32_MAX;
    for (size_t i = 0; i < c->slot_count; i++) {
        if (!is_ready(&c->slots[i])) continue;
        uint32_t at = c->slots[i].frame, far = at > frame ? at - frame : frame - at;
        if (s->desc.loop == SEQUENCE_REPEAT && s->frame_count - far < far)
            far = s->frame_count - far;
        if (far > least || (far == least && at > best->frame)) continue;
        best = &c->slots[i];
        least = far;
    }
    return show(s, best);
}

bool sequence_cache_failed(sequence_data *s, gpu *g, uint32_t frame) {
    sequence_job *job = sequence_job_find(s, frame);
    if (!job || sequence_job_state(job) != JOB_DECODED || job->ok) return false;
    complete(s, g, job);
    return true;
}

void sequence_cache_turn(sequence_data *s) {
    s->cache.turn++;
}

void sequence_cache_free(sequence_data *s, gpu *g) {
    sequence_cache *c = &s->cache;
    if (c->slot_count == 0) return;
    sequence_jobs_end(s, g);
    for (size_t i = 0; i < SEQUENCE_TRANSFERS; i++) gpu_transfer_destroy(g, c->idle[i]);
    for (size_t i = 0; i < c->slot_count; i++) sequence_slot_free(&c->slots[i], g);
    mem_free(c->slots);
    memset(c, 0, sizeof *c);
}
