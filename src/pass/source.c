// What a pass takes from others: `from` in an effect file. What structure is (images, fields,
// options) is taken once; a uniform is looked up in every frame, so that what moves it there moves
// it here.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include <string.h>

static void take_images(pass *p, const pass *source) {
    for (size_t i = 0; i < p->face->image_count; i++) {
        const shader_image *input = &p->face->images[i];
        if (input->output || input->history || p->images[i].id) continue;
        for (size_t k = 0; k < source->face->image_count; k++) {
            const shader_image *output = &source->face->images[k];
            if (output->output && output->volume == input->volume &&
                strcmp(output->name, input->name) == 0)
                p->images[i] = source->images[k];
        }
    }
}

static void take_fields(pass *p, const pass *source) {
    for (size_t i = 0; i < p->face->field_count; i++) {
        const shader_field *own = &p->face->fields[i];
        for (size_t k = 0; k < source->face->field_count && !p->fields[i]; k++) {
            const shader_field *other = &source->face->fields[k];
            if (other->components == own->components && strcmp(other->name, own->name) == 0)
                p->fields[i] = source->fields[k];
        }
    }
}

// The word of an option there, if it is one here too.
static bool take_word(pass *p, size_t index, const char *word) {
    int found = value_find_word(&p->face->options[index], word);
    if (found >= 0) p->options[index] = (size_t)found;
    return found >= 0;
}

static void take_options(pass *p, const pass *source) {
    for (size_t i = 0; i < p->face->option_count; i++) {
        for (size_t k = 0; k < source->face->option_count && !p->chosen[i]; k++) {
            const value_desc *other = &source->face->options[k];
            if (strcmp(other->name, p->face->options[i].name) == 0)
                p->chosen[i] = take_word(p, i, other->words[source->options[k]]);
        }
    }
}

// The first source that has a uniform like this one; NULL: none.
static pass_parent find_parent(const pass *p, const value_desc *like) {
    for (size_t i = 0; i < p->source_count; i++) {
        const shader_interface *face = p->sources[i]->face;
        for (size_t k = 0; k < face->uniform_count; k++) {
            const value_desc *u = &face->uniforms[k];
            if (u->type == like->type && u->word_count == like->word_count &&
                strcmp(u->name, like->name) == 0)
                return (pass_parent){p->sources[i], k};
        }
    }
    return (pass_parent){NULL, 0};
}

// Names are compared here, once, not in every frame.
static void find_parents(pass *p) {
    const size_t count = p->face->uniform_count;
    if (!p->parents) p->parents = arena_alloc(p->host->memory, (count + 1) * sizeof *p->parents);
    for (size_t i = 0; i < count; i++) p->parents[i] = find_parent(p, &p->face->uniforms[i]);
}

void pass_add_uniforms_of(pass *p, pass *source) {
    for (size_t i = 0; i < p->source_count; i++)
        if (p->sources[i] == source) return;
    *MEM_ADD(p->sources, p->source_count, p->source_capacity) = source;
    find_parents(p);
}

void pass_add_source(pass *p, pass *source) {
    pass_add_uniforms_of(p, source);
    take_images(p, source);
    take_fields(p, source);
    take_options(p, source);
}

const pass *pass_uniform_owner(const pass *p, size_t *index) {
    while (!p->uniforms[*index] && p->parents && p->parents[*index].pass) {
        const pass_parent *parent = &p->parents[*index];
        p = parent->pass;
        *index = parent->index;
    }
    return p;
}

const field *pass_inherited_uniform(const pass *p, size_t index, const value_desc **declared) {
    *declared = &p->face->uniforms[index];
    if (!p->parents || !p->parents[index].pass) return NULL;
    const pass_parent *parent = &p->parents[index];
    size_t there = parent->index;
    p = pass_uniform_owner(parent->pass, &there);
    *declared = &p->face->uniforms[there];
    return p->uniforms[there];
}
