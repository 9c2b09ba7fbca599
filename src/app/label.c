// Text on a canvas.
#include "app/label.h"
#include "app/panel_model.h"

void label_right(float right, float y, uint32_t color, const char *text) {
    ui_label(right - ui_text_width(text), y, color, text);
}

void label_center(float x, float y, uint32_t color, const char *text) {
    ui_label(x - ui_text_width(text) / 2, y, color, text);
}

void label_within(float left, float y, float width, uint32_t color, const char *text) {
    char shown[256];
    panel_shorten(text, width, ui_text_width, shown, sizeof shown);
    ui_label(left, y, color, shown);
}
