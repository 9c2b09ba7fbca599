// Values that the script of the effect reports (fx:status), in a corner of the picture.
#include "app/label.h"
#include "app/live.h"
#include <math.h>
#include <string.h>

enum { MOST = 96 };                                     // readouts of an effect that are looked at
static const float PADDING = 12, GAP = 16, MARGIN = 16; // units

void status_draw(const live *l, ui_rect view) {
    roil_readout all[MOST], *shown = all;
    size_t count = l->effect ? roil_readouts(l->effect, all, MOST) : 0;
    count = count < MOST ? count : MOST;
    for (; count > 0 && strcmp(shown->pass, "effect") != 0; count--) shown++; // they come last
    if (!count) return;
    float s = ui_scale(), names = 0, values = 0, row = label_height() + 4 * s;
    char text[96];
    for (size_t i = 0; i < count; i++) {
        app_format_readout(&shown[i], text, sizeof text);
        names = fmaxf(names, ui_text_width(shown[i].name));
        values = fmaxf(values, ui_text_width(text));
    }
    float left = floorf(view.left + MARGIN * s), top = floorf(view.top + MARGIN * s);
    float right = left + names + values + (2 * PADDING + GAP) * s;
    float bottom = top + (float)count * row + (2 * PADDING - 4) * s;
    if (right > view.right || bottom > view.bottom) return; // no room
    ui_fill((ui_rect){left, top, right, bottom}, ui_rgba(UI_PANEL, 0.8f), 6 * s);
    for (size_t i = 0; i < count; i++) {
        float y = top + PADDING * s + (float)i * row;
        app_format_readout(&shown[i], text, sizeof text);
        ui_label(left + PADDING * s, y, ui_rgba(UI_DIM, 1), shown[i].name);
        label_right(right - PADDING * s, y, ui_rgba(UI_TEXT, 1), text);
    }
}
