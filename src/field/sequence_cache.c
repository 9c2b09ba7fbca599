// Textures of the frames shown lately, and a thread that decodes those to come.
//
// A frame wanted now is taken from the textures, else from the thread if it has begun, else decoded
// here. Jobs are owned by the cache until they are cancelled; a cancelled job is freed by the
// thread when its turn comes. The least recently used texture makes room, within a memory budget.
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "field/sequence_parts.h"
#include <string.h>

enum { LEAST_SLOTS = 4, MOST_SLOTS = 4096 };

static uint64_t frame_bytes(const sequence_data *s) {
    uint64_t voxels = (uint64_t)s->size[0] * s->size[1] * s->size[2], bytes = 0;
    for (int i = 0; i < FIELD_GRID_IMAGES; i++) {
        int count = sequence_image_channels(s, i);
        bytes += voxels * (uint64_t)(count == 3 ? 4 : count) * sizeof(uint16_t);
    }
    return bytes;
}

static void start(sequence_data *s, gpu *g) {
    sequence_cache *c = &s->cache;
    const uint64_t mebi = 1 << 20;
    uint64_t budget = (gpu_get_info(g)->kind == GPU_CPU ? 192 : 512) * mebi;
    uint64_t count = budget / frame_bytes(s);
    if (count > s->frame_count) count = s->frame_count;
    c->slot_count = (size_t)(count < LEAST_SLOTS  ? LEAST_SLOTS
                             : count > MOST_SLOTS ? MOST_SLOTS
                                                  : count);
    c->slots = mem_alloc(c->slot_count * sizeof *c->slots);
    pthread_mutex_init(&c->lock, NULL);
    pthread_cond_init(&c->done, NULL);
    c->thread = worker_create(1);
}

// ---- decoding ahead ---------------------------------------------------------------------------

static void run_job(void *user) {
    sequence_job *job = user;
    sequence_cache *c = (sequence_cache *)&job->owner->cache;
    pthread_mutex_lock(&c->lock);
    bool cancelled = job->state == JOB_CANCELLED;
    if (!cancelled) job->state = JOB_RUNNING;
    pthread_mutex_unlock(&c->lock);
    if (cancelled) {
        mem_free(job);
        return;
    }
    job->ok = sequence_decode(job->owner, job->frame, &job->texels);
    if (!job->ok) str_copy(job->message, sizeof job->message, err_get());
    pthread_mutex_lock(&c->lock);
    job->state = JOB_DONE;
    pthread_cond_broadcast(&c->done);
    pthread_mutex_unlock(&c->lock);
}

static sequence_job **find_job(sequence_cache *c, uint32_t frame) {
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++)
        if (c->jobs[i] && c->jobs[i]->frame == frame) return &c->jobs[i];
    return NULL;
}

// Gives up a job unless the thread is at it.
static void drop_job(sequence_cache *c, sequence_job **place) {
    sequence_job *job = *place;
    pthread_mutex_lock(&c->lock);
    int state = job->state;
    if (state == JOB_QUEUED) job->state = JOB_CANCELLED;
    pthread_mutex_unlock(&c->lock);
    if (state == JOB_RUNNING) return;
    *place = NULL;
    if (state != JOB_DONE) return;
    sequence_texels_free(&job->texels);
    mem_free(job);
}

// The texels of a frame, from the thread or by decoding here.
static bool take(sequence_data *s, uint32_t frame, sequence_texels *out) {
    sequence_cache *c = &s->cache;
    sequence_job **place = find_job(c, frame);
    if (!place) return sequence_decode(s, frame, out);
    sequence_job *job = *place;
    pthread_mutex_lock(&c->lock);
    bool waiting = job->state == JOB_QUEUED;
    if (waiting) job->state = JOB_CANCELLED; // behind other frames: faster here
    while (!waiting && job->state != JOB_DONE) pthread_cond_wait(&c->done, &c->lock);
    pthread_mutex_unlock(&c->lock);
    *place = NULL;
    if (waiting) return sequence_decode(s, frame, out);
    bool ok = job->ok;
    *out = job->texels;
    if (!ok) err_set("%s", job->message);
    mem_free(job);
    return ok;
}

static sequence_slot *find_slot(sequence_cache *c, uint32_t frame) {
    for (size_t i = 0; i < c->slot_count; i++)
        if (c->slots[i].used > 0 && c->slots[i].frame == frame) return &c->slots[i];
    return NULL;
}

void sequence_cache_ahead(sequence_data *s, const uint32_t *frames, size_t count) {
    sequence_cache *c = &s->cache;
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++) {
        bool wanted = false;
        for (size_t k = 0; c->jobs[i] && k < count; k++)
            wanted = wanted || c->jobs[i]->frame == frames[k];
        if (c->jobs[i] && !wanted) drop_job(c, &c->jobs[i]);
    }
    for (size_t k = 0; k < count; k++) {
        size_t place = 0;
        while (place < SEQUENCE_MAX_JOBS && c->jobs[place]) place++;
        if (place == SEQUENCE_MAX_JOBS) return;
        if (find_job(c, frames[k]) || find_slot(c, frames[k])) continue;
        sequence_job *job = mem_alloc(sizeof *job);
        job->owner = s;
        job->frame = frames[k];
        c->jobs[place] = job;
        worker_submit(c->thread, (worker_job){run_job, job});
    }
}

// ---- textures ---------------------------------------------------------------------------------

static bool make_images(sequence_data *s, gpu *g, sequence_slot *slot) {
    static const gpu_format formats[] = {GPU_FORMAT_NONE, GPU_R16F, GPU_RG16F, GPU_RGBA16F,
                                         GPU_RGBA16F};
    for (int i = 0; i < FIELD_GRID_IMAGES && sequence_image_channels(s, i) > 0; i++) {
        if (slot->images[i]) continue;
        slot->images[i] = gpu_image_create(g, &(gpu_image_desc){
                                                  .label = s->name,
                                                  .format = formats[sequence_image_channels(s, i)],
                                                  .width = s->size[0],
                                                  .height = s->size[1],
                                                  .depth = s->size[2],
                                                  .use = GPU_USE_SAMPLED,
                                              });
        if (!slot->images[i]) return err_prefix("%s: ", s->name);
    }
    return true;
}

static bool upload(sequence_data *s, gpu *g, sequence_slot *slot, const sequence_texels *texels) {
    if (!make_images(s, g, slot)) return false;
    size_t voxels = (size_t)s->size[0] * s->size[1] * s->size[2];
    for (int i = 0; i < FIELD_GRID_IMAGES && slot->images[i]; i++) {
        int count = sequence_image_channels(s, i);
        size_t size = voxels * (size_t)(count == 3 ? 4 : count) * sizeof(uint16_t);
        if (!gpu_image_write(g, slot->images[i], 0, texels->images[i], size))
            return err_prefix("%s: ", s->name);
    }
    return true;
}

static void warn(sequence_data *s, uint32_t frame, uint64_t bad) {
    if (bad == 0 || s->cache.warned) return;
    s->cache.warned = true;
    log_write(LOG_WARNING, "%s: %llu values of frame %u are not finite; they count as 0", s->name,
              (unsigned long long)bad, frame + 1);
}

sequence_slot *sequence_cache_get(sequence_data *s, gpu *g, uint32_t frame) {
    sequence_cache *c = &s->cache;
    if (c->slot_count == 0) start(s, g);
    sequence_slot *slot = find_slot(c, frame);
    c->turn++;
    if (slot) {
        slot->used = c->turn;
        return slot;
    }
    sequence_texels texels;
    if (!take(s, frame, &texels)) return NULL;
    slot = &c->slots[0];
    for (size_t i = 1; i < c->slot_count; i++)
        if (c->slots[i].used < slot->used) slot = &c->slots[i];
    slot->used = 0; // in case the upload fails half-way
    bool ok = upload(s, g, slot, &texels);
    warn(s, frame, texels.bad);
    sequence_texels_free(&texels);
    if (!ok) return NULL;
    slot->frame = frame;
    slot->active = texels.active;
    slot->used = c->turn;
    return slot;
}

void sequence_cache_free(sequence_data *s, gpu *g) {
    sequence_cache *c = &s->cache;
    if (c->slot_count == 0) return;
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++)
        if (c->jobs[i]) drop_job(c, &c->jobs[i]);
    worker_destroy(c->thread);
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++) // one may have been running
        if (c->jobs[i]) drop_job(c, &c->jobs[i]);
    for (size_t i = 0; i < c->slot_count; i++)
        for (int k = 0; k < FIELD_GRID_IMAGES; k++) gpu_image_destroy(g, c->slots[i].images[k]);
    mem_free(c->slots);
    pthread_mutex_destroy(&c->lock);
    pthread_cond_destroy(&c->done);
    memset(c, 0, sizeof *c);
}
