// Per-resource synchronisation, after libplacebo's vk_sem_barrier and LOVR's syncResource.
//
// Invariant: when an access was tracked and its barrier recorded, the access is ordered behind
// every earlier one that it conflicts with, directly or through the chain of barriers between.
#include "gpu/hazard.h"

// Visibility is kept as two sets. Their product may name a pair (stage, access) that no barrier
// covered, so both sets are only widened together with a barrier of exactly their union.
static bool sees_last_write(const hazard_state *s, const hazard_access *a) {
    return (a->stages & ~s->visible_stages) == 0 && (a->reads & ~s->visible_access) == 0;
}

bool hazard_track(hazard_state *s, const hazard_access *a, hazard_barrier *out) {
    bool relayout = a->layout != s->layout;
    bool write = a->writes != 0 || relayout;
    bool needed;
    *out = (hazard_barrier){.stages = a->stages,
                            .access = a->reads | a->writes,
                            .old_layout = s->layout,
                            .layout = a->layout};
    if (write) {
        // Readers waited for the write before them, so waiting for all of them is enough, but
        // only if there are any: else the writer itself is what must be waited for.
        out->source_stages = s->read_stages | s->write_stages;
        out->source_access = s->write_access;
        needed = relayout || out->source_stages != 0;
        *s = (hazard_state){.write_stages = a->stages,
                            .write_access = a->writes,
                            .read_stages = a->reads ? a->stages : 0,
                            .layout = a->layout};
        if (a->writes == 0) {
            s->visible_stages = a->stages;
            s->visible_access = a->reads;
        }
        return needed;
    }

    needed = s->write_stages != 0 && !sees_last_write(s, a);
    if (needed) {
        out->source_stages = s->write_stages;
        out->source_access = s->write_access;
        s->visible_stages |= a->stages;
        s->visible_access |= a->reads;
        out->stages = s->visible_stages;
        out->access = s->visible_access;
    }
    s->read_stages |= a->stages;
    return needed;
}

bool hazard_merge(hazard_access *into, const hazard_access *add) {
    if (into->layout != add->layout) {
        bool shader_only = (into->layout == VK_IMAGE_LAYOUT_GENERAL ||
                            into->layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) &&
                           (add->layout == VK_IMAGE_LAYOUT_GENERAL ||
                            add->layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        if (!shader_only || into->writes != 0 || add->writes != 0) return false;
        into->layout = VK_IMAGE_LAYOUT_GENERAL;
    }
    into->stages |= add->stages;
    into->reads |= add->reads;
    into->writes |= add->writes;
    return true;
}
