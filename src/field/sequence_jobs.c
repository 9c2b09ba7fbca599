// Frames ahead of time: a few threads decode them, write them into memory that is copied from, and
// the thread of the device begins the copies (sequence_cache_pump), so that this one neither
// decodes nor waits. A job belongs to the cache until it is dropped; one that is dropped while it
// waits for a thread is freed by that thread when its turn comes.
#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "field/sequence_parts.h"
#include <string.h>

enum { MOST_THREADS = 12 };

void sequence_jobs_start(sequence_data *s) {
    sequence_jobs *j = &s->cache.jobs;
    const uint32_t cores = worker_cores();
    j->threads = cores > 2 ? cores - 2 : 1;
    if (j->threads > MOST_THREADS) j->threads = MOST_THREADS;
    // A dense frame is decoded by way of floats, twice its bytes: not many at once.
    const uint64_t most = (uint64_t)2 << 30,
                   voxels = (uint64_t)s->size[0] * s->size[1] * s->size[2];
    uint64_t frame = voxels * 6 * (uint64_t)s->width;
    if (!s->sparse && frame * j->threads > most)
        j->threads = frame < most ? (uint32_t)(most / frame) : 1;
    pthread_mutex_init(&j->lock, NULL);
    pthread_cond_init(&j->done, NULL);
    j->pool = worker_create(j->threads);
}

static void finish(sequence_job *job, int state) {
    sequence_jobs *j = (sequence_jobs *)&job->owner->cache.jobs;
    pthread_mutex_lock(&j->lock);
    job->state = state;
    pthread_cond_broadcast(&j->done);
    pthread_mutex_unlock(&j->lock);
}

static void decode(void *user) {
    sequence_job *job = user;
    sequence_jobs *j = (sequence_jobs *)&job->owner->cache.jobs;
    pthread_mutex_lock(&j->lock);
    bool dropped = job->state == JOB_DROPPED;
    if (!dropped) job->state = JOB_DECODING;
    pthread_mutex_unlock(&j->lock);
    if (dropped) {
        mem_free(job);
        return;
    }
    double begin = clock_seconds();
    job->ok = sequence_decode(job->owner, job->frame, &job->texels);
    if (!job->ok) str_copy(job->message, sizeof job->message, err_get());
    job->seconds = clock_seconds() - begin;
    finish(job, JOB_DECODED);
}

static void stage(void *user) {
    sequence_job *job = user;
    sequence_upload_write(job->owner, &job->texels, gpu_transfer_map(job->transfer));
    sequence_texels_drop(&job->texels); // here, as that takes milliseconds
    finish(job, JOB_STAGED);
}

void sequence_job_stage(sequence_job *job) {
    job->state = JOB_STAGING; // no thread has it now
    worker *pool = job->owner->cache.jobs.pool;
    if (!pool)
        stage(job); // no thread could be made
    else
        worker_submit_first(pool, (worker_job){stage, job});
}

int sequence_job_state(sequence_job *job) {
    sequence_jobs *j = (sequence_jobs *)&job->owner->cache.jobs;
    pthread_mutex_lock(&j->lock);
    int state = job->state;
    pthread_mutex_unlock(&j->lock);
    return state;
}

int sequence_job_wait(sequence_job *job) {
    sequence_jobs *j = (sequence_jobs *)&job->owner->cache.jobs;
    pthread_mutex_lock(&j->lock);
    while (job->state == JOB_DECODING || job->state == JOB_STAGING)
        pthread_cond_wait(&j->done, &j->lock);
    int state = job->state;
    pthread_mutex_unlock(&j->lock);
    return state;
}

sequence_job *sequence_job_find(const sequence_data *s, uint32_t frame) {
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++) {
        sequence_job *job = s->cache.jobs.list[i];
        if (job && job->frame == frame) return job;
    }
    return NULL;
}

bool sequence_job_add(sequence_data *s, uint32_t frame) {
    sequence_jobs *j = &s->cache.jobs;
    size_t place = 0;
    while (place < SEQUENCE_MAX_JOBS && j->list[place]) place++;
    if (place == SEQUENCE_MAX_JOBS || !sequence_may_prepare(NULL, sequence_decode_bytes(s, frame)))
        return false;
    sequence_job *job = mem_alloc(sizeof *job);
    job->owner = s;
    job->frame = frame;
    j->list[place] = job;
    if (j->pool)
        worker_submit(j->pool, (worker_job){decode, job});
    else
        decode(job);
    return true;
}

bool sequence_job_drop(sequence_data *s, sequence_job *job) {
    sequence_jobs *j = &s->cache.jobs;
    pthread_mutex_lock(&j->lock);
    int state = job->state;
    if (state == JOB_QUEUED) job->state = JOB_DROPPED;
    pthread_mutex_unlock(&j->lock);
    if (state == JOB_DECODING || state == JOB_STAGING) return false;
    for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++)
        if (j->list[i] == job) j->list[i] = NULL;
    if (state == JOB_QUEUED) return true;
    sequence_texels_free(&job->texels);
    mem_free(job);
    return true;
}

void sequence_jobs_end(sequence_data *s, gpu *g) {
    sequence_jobs *j = &s->cache.jobs;
    for (int running = 0; running < 2; running++) { // of which no thread is left the second time
        for (size_t i = 0; i < SEQUENCE_MAX_JOBS; i++) {
            sequence_job *job = j->list[i];
            if (!job) continue;
            gpu_transfer *transfer = job->transfer;
            if (sequence_job_drop(s, job)) gpu_transfer_destroy(g, transfer);
        }
        worker_destroy(j->pool);
        j->pool = NULL;
    }
    pthread_mutex_destroy(&j->lock);
    pthread_cond_destroy(&j->done);
}
