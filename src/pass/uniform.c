// What uniforms of a pass are in a frame: by itself or by a source, kept within the range that its
// shader declares. A constant was refused beyond it; what moves is cut off there, and that is told.
#include "base/error.h"
#include "base/log.h"
#include "pass/pass_impl.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

// Rounding does not count: a curve may come to 1.0000001.
static bool is_cut(const value_desc *u, float value, float taken) {
    if (!isfinite(value)) return true;
    float span = u->max - u->min;
    if (!isfinite(span)) span = fmaxf(fabsf(taken), fabsf(u->value[0]));
    return fabsf(value - taken) > 1e-5f * span;
}

// Once, where it is said: what moves it would be told of in every frame, by every pass that asks. A
// window shows one warning until it is cleared, and then the next that still holds.
static void tell_cut(const pass *owner, size_t index, const value_desc *u, float value,
                     float taken) {
    pass_host *host = owner->host;
    if (owner->warned[index] && host->warning[0]) return;
    char text[sizeof host->warning], range[VALUE_RANGE];
    value_range(u, range);
    snprintf(text, sizeof text, "%s%s: uniform '%s' is %g at %g s; accepted: %s; it counts as %g",
             owner->place, owner->label, u->name, (double)value, host->context->time, range,
             (double)taken);
    if (!owner->warned[index]) log_write(LOG_WARNING, "%s", text);
    if (!host->warning[0]) memcpy(host->warning, text, sizeof text);
    owner->warned[index] = true;
}

bool pass_evaluate_at(const pass *p, size_t index, float out[4]) {
    const value_desc *uniform = &p->face->uniforms[index];
    size_t there = index;
    const pass *owner = pass_uniform_owner(p, &there);
    const field *node = owner->uniforms[there];
    float value[4];
    memcpy(value, owner->face->uniforms[there].value, sizeof value);
    if (node && !field_eval(node, p->host->context, (float3){0, 0, 0}, value))
        return err_prefix("uniform '%s': ", uniform->name);
    const bool moves = node && !field_is_constant(node);
    const int count = uniform->components;
    for (int i = 0; i < 4; i++) {
        float v = node && node->components == 1 ? value[0] : value[i];
        out[i] = isfinite(v) ? clampf(v, uniform->min, uniform->max) : uniform->value[i];
        if (moves && i < count && is_cut(uniform, v, out[i]))
            tell_cut(owner, there, uniform, v, out[i]);
    }
    return true;
}
