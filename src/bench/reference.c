// Pictures of references: drawn once and stored as files, so that the next row and the next run of
// the same sweep find them.
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "bench/run_parts.h"
#include <stdio.h>

static hash128 reference_hash(const bench_row *row, uint32_t samples) {
    uint32_t numbers[] = {row->width, row->height, row->warmup, samples};
    hash128 h = hash_combine(hash_bytes(numbers, sizeof numbers),
                             hash_bytes(row->frames, row->frame_count * sizeof *row->frames));
    h = hash_add_text(h, row->effect);
    for (size_t i = 0; i < row->settings.count; i++)
        h = hash_add_text(hash_add_text(h, row->settings.items[i].name),
                          row->settings.items[i].value);
    return h;
}

static bool picture_path(char out[PATH_CAP], const bench_session *s, hash128 h, size_t frame) {
    char hex[33], name[80];
    hash_to_hex(h, hex);
    snprintf(name, sizeof name, "reference/%s-%zu.png", hex, frame);
    return path_join(out, s->folder, name);
}

static bool is_complete(const bench_session *s, const bench_row *row, hash128 h) {
    char path[PATH_CAP];
    for (size_t i = 0; i < row->frame_count; i++)
        if (bench_is_compared(s, row, i) && (!picture_path(path, s, h, i) || !file_exists(path)))
            return false;
    return true;
}

static bool save_picture(bench_drawing *d, hash128 h, size_t i) {
    bench_picture p;
    char path[PATH_CAP];
    const bench_row *row = d->row;
    if (!picture_path(path, d->session, h, i) ||
        !bench_picture_read(d->effect, row->width, row->height, &p))
        return false;
    bool done = bench_picture_save(&p, d->session->folder, path);
    mem_free(p.pixels);
    return done;
}

// Draws the same frame until it has its samples.
static bool reference_trace(bench_drawing *d, double frame, uint32_t samples) {
    bool done = bench_draw(d, frame);
    while (done && roil_samples(d->effect) < samples) {
        if (!roil_samples(d->effect))
            return err_set("%s: its picture does not show what a pass `march` draws, which is "
                           "what a reference traces",
                           d->row->effect);
        roil_time times[1];
        roil_times(d->effect, times, 1); // waits: an interrupt shall be heard
        if (bench_is_stopped(d->session)) {
            d->stopped = true;
            return false;
        }
        done = roil_advance(d->effect, frame);
    }
    return done;
}

static bool draw_reference(bench_drawing *d, uint32_t samples, hash128 h) {
    const bench_row *row = d->row;
    bool done = samples > 0 || bench_draw_warmup(d);
    for (size_t i = 0; done && i < row->frame_count; i++) {
        bool wanted = bench_is_compared(d->session, row, i);
        if (samples == 0)
            done = bench_draw(d, row->frames[i]);
        else if (wanted)
            done = reference_trace(d, row->frames[i], samples);
        if (done && wanted) done = save_picture(d, h, i);
    }
    return done;
}

static bool make_reference(bench_session *s, const bench_row *row, uint32_t samples, hash128 h) {
    bench_drawing d;
    roil_set_reference(s->r, samples);
    bool done = bench_drawing_begin(s, row, &d) && draw_reference(&d, samples, h);
    bench_drawing_end(&d);
    roil_set_reference(s->r, 0);
    if (!done && !d.stopped) err_prefix("the reference: ");
    return done;
}

bool bench_compare_row(bench_session *s, const bench_job *job, bench_row *row,
                       const bench_picture *pictures, size_t count) {
    bench_row reference = *job->reference;
    reference.frames = row->frames;
    reference.frame_count = row->frame_count;
    hash128 h = reference_hash(&reference, job->samples);
    if (!is_complete(s, &reference, h) && !make_reference(s, &reference, job->samples, h))
        return false;
    bool done = true;
    for (size_t i = 0, k = 0; done && i < row->frame_count && k < count; i++) {
        bench_picture wanted;
        char path[PATH_CAP];
        if (!bench_is_compared(s, row, i)) continue;
        done = picture_path(path, s, h, i) && bench_picture_load(s->folder, path, &wanted);
        if (!done) break;
        done = bench_picture_compare(&pictures[k++], &wanted, row);
        mem_free(wanted.pixels);
    }
    return done;
}
