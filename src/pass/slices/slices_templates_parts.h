// The inside of templates of slices, for their own files only.
#pragma once
#include "pass/slices/slices_parts.h"
#include "pass/slices/slices_templates.h"

typedef struct template_hand { // templates that are put by hand; zero: none may be
    bool taken;                // they may
    slices_hand at[SLICES_HAND_MOST];
    double left[SLICES_HAND_MOST];           // seconds of its life; 0: there is none
    const picture *images[SLICES_HAND_MOST]; // of the tiles
} template_hand;

struct slices_templates {
    template_set set; // its tiles are those of groups, then those by hand
    template_hand hand;
    bool repainted; // tiles are others than those of the image
};

slices_templates *slices_templates_make(slices_flow *f); // again: those that are there

// Of a flow that has templates.
bool slices_templates_allocate(slices_flow *f);
void slices_templates_list_memory(const slices_flow *f, budget_list *out);
void slices_templates_destroy(slices_flow *f);
// Before a step, when inflow and forces are in the solver's buffers, which are written anew for
// every step then. The host's context has the time of the step.
bool slices_templates_run(slices_flow *f);

void slices_templates_define(const slices_flow *f, pass_defines *out); // of all their shaders

// slices_templates_draw.c
void slices_templates_define_draw(const slices_flow *f, pass_defines *out);
bool slices_templates_make_images(slices_flow *f);
bool slices_templates_draw(slices_flow *f);
// A kernel of the pass, with the solver's and the templates' buffers bound, too.
kernel *slices_templates_use(const slices_flow *f, pass *p, size_t index);

// slices_hand.c
void slices_hand_tile(const void *templates, uint32_t slot, float *out); // of slices_templates
// Tells the kernel that draws what is put by hand in this step, and ages it.
void slices_hand_set(slices_flow *f, kernel *k);
