// Windows, layout and widgets of ui.h, and the parts that widgets.c uses, over Dear ImGui.
#include "ui/ui_state.hpp"

using namespace face;

static const float TIP_SECONDS = 0.45f, TIP_WIDTH = 340, CARD_ROUNDING = 6, CARD_EDGE = 4;

// ---- windows and layout -----------------------------------------------------------------------

static const ImGuiWindowFlags STILL = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoBringToFrontOnFocus;

static void panel_begin(const char *name, ui_rect where, ImGuiWindowFlags flags, bool framed) {
    ImGui::SetNextWindowPos(low(where));
    ImGui::SetNextWindowSize(high(where) - low(where));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, framed ? CARD_ROUNDING * ui.scale : 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, framed ? ui.scale : 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::Begin(name, nullptr, flags);
    ui_mark(name, where);
    ImGui::PopStyleVar(3);
    if (!ui.depth++) ui.panel = true;
}

void ui_panel_begin(const char *name, ui_rect where) {
    panel_begin(name, where, STILL, false);
}

void ui_panel_end(void) {
    ui.depth--;
    ImGui::End();
}

void ui_card_begin(const char *name, ui_rect where, uint32_t edge) {
    ImVec2 display = ImGui::GetIO().DisplaySize, size = high(where) - low(where);
    float left = fmaxf(fminf(where.left, display.x - size.x), 0);
    float top = fmaxf(fminf(where.top, display.y - size.y), 0);
    panel_begin(name, {left, top, fminf(left + size.x, display.x), fminf(top + size.y, display.y)},
                STILL | ImGuiWindowFlags_NoFocusOnAppearing, true);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    list()->PushClipRectFullScreen(); // beyond the padding
    list()->AddRectFilled(ImVec2(left, top), ImVec2(left + CARD_EDGE * ui.scale, top + size.y),
                          edge, CARD_ROUNDING * ui.scale, ImDrawFlags_RoundCornersLeft);
    list()->PopClipRect();
}

void ui_card_end(void) {
    ui_panel_end();
}

bool ui_window_begin(const char *title, bool *open, ui_rect where, bool fixed) {
    ImGui::SetNextWindowPos(low(where), ImGuiCond_FirstUseEver);
    if (!fixed) ImGui::SetNextWindowSize(high(where) - low(where), ImGuiCond_FirstUseEver);
    bool visible = ImGui::Begin(
        title, open, ImGuiWindowFlags_NoCollapse | (fixed ? ImGuiWindowFlags_AlwaysAutoResize : 0));
    ImVec2 at = ImGui::GetWindowPos(), end = at + ImGui::GetWindowSize();
    ui_mark(title, {at.x, at.y, end.x, end.y});
    if (!ui.depth++) ui.panel = false;
    return visible;
}

void ui_window_end(void) {
    ui_panel_end();
}

void ui_scroll_to_top(void) {
    ImGui::SetScrollY(0);
}

ui_rect ui_space(void) {
    ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    return {at.x, at.y, at.x + room.x, at.y + room.y};
}

void ui_same_line(void) {
    ImGui::SameLine();
}

void ui_align_right(float width) {
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
}

void ui_separator(void) {
    ImGui::Separator();
}

void ui_push(const char *id) {
    ImGui::PushID(id);
    marks_push(id);
}

void ui_pop(void) {
    marks_pop();
    ImGui::PopID();
}

void ui_disable_begin(bool disabled) {
    ImGui::BeginDisabled(disabled);
}

void ui_disable_end(void) {
    ImGui::EndDisabled();
}

void ui_table_begin(const char *id, int columns, const float *widths) {
    IM_ASSERT(ui.table_depth < MAX_TABLES);
    bool visible = ImGui::BeginTable(
        id, columns, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoSavedSettings);
    for (int i = 0; visible && i < columns; i++)
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, widths[i]);
    ui.tables[ui.table_depth++] = visible;
}

void ui_table_next(void) {
    part_forget_width();
    if (!ui.tables[ui.table_depth - 1]) return;
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding(); // a label beside a widget
}

void ui_table_end(void) {
    if (ui.tables[--ui.table_depth]) ImGui::EndTable();
}

// ---- text -------------------------------------------------------------------------------------

void part_text(uint32_t color, const char *text, bool wrapped) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(wrapped ? 0 : -1);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

void ui_text_wrapped(const char *text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
}

// Shows the tooltip only after the pointer has rested, so that nothing flickers as it moves.
void ui_tooltip(const char *text) {
    if (!text || !text[0] || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImVec2 at = ImGui::GetItemRectMin();
    bool same = at.x == ui.tip_at.x && at.y == ui.tip_at.y && !ImGui::IsAnyMouseDown() &&
                !ImGui::GetIO().WantTextInput;
    ui.tip_seconds = same ? ui.tip_seconds + ImGui::GetIO().DeltaTime : 0;
    ui.tip_at = at;
    if (ui.tip_seconds < TIP_SECONDS) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(TIP_WIDTH * ui.scale);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

float ui_text_width(const char *text) {
    return ImGui::CalcTextSize(text).x;
}

float ui_line_height(void) {
    return ImGui::GetTextLineHeightWithSpacing();
}

// ---- widgets ----------------------------------------------------------------------------------

uint32_t draw_enabled(uint32_t color) {
    return ImGui::GetColorU32(rgba(color));
}

void draw_text_in(ui_rect area, uint32_t color, const char *text, float align) {
    const char *end = ImGui::FindRenderedTextEnd(text);
    ImVec2 size = ImGui::CalcTextSize(text, end);
    float room = area.right - area.left, x = area.left + fmaxf(room - size.x, 0) * align;
    float y = floorf((area.top + area.bottom - size.y) / 2);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::RenderTextEllipsis(list(), ImVec2(floorf(x), y), high(area), area.right, area.right,
                              text, end, &size);
    ImGui::PopStyleColor();
}

void draw_clipped(ui_rect area, ui_rect clip, uint32_t color, float rounding) {
    list()->PushClipRect(low(clip), high(clip), true);
    ui_fill(area, color, rounding);
    list()->PopClipRect();
}

void part_group_begin(const char *id) {
    ImGui::BeginGroup();
    ImGui::PushID(id);
}

void part_space(float width, float height) {
    ImGui::Dummy(ImVec2(width, height));
}

static void mark_last(const char *name) {
    if (ImGui::GetCurrentWindow()->Hidden) return; // a popup whose place is not known yet
    ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    ui_mark(name, {a.x, a.y, b.x, b.y});
}

void part_group_end(const char *id) {
    ImGui::PopID();
    ImGui::EndGroup();
    mark_last(id);
}

void part_same_line(float gap) {
    ImGui::SameLine(0, gap);
}

// Shows where keys are, on what ImGui does not draw itself.
static void show_focus(ImGuiID id, ImVec2 low, ImVec2 high) {
    if (!ui.walks || GImGui->NavId != id || GImGui->NavDisableHighlight) return;
    ImGui::RenderNavHighlight(ImRect(low, high), id);
    ui_mark("focus", {low.x, low.y, high.x, high.y});
}

part_area part_area_begin(const char *id, float width) {
    ImVec2 at = ImGui::GetCursorScreenPos();
    float height = ImGui::GetFrameHeight();
    part_area a = {};
    if (!(width > 0)) width = height;
    a.clicked = ImGui::InvisibleButton(id, ImVec2(fmaxf(width, 1), height));
    show_focus(ImGui::GetItemID(), at, ImVec2(at.x + fmaxf(width, 1), at.y + height));
    ImGui::SetItemAllowOverlap();
    float &baseline = ImGui::GetCurrentWindow()->DC.PrevLineTextBaseOffset; // of text behind it
    baseline = fmaxf(baseline, ImGui::GetStyle().FramePadding.y);
    a.hovered = ImGui::IsItemHovered();
    a.held = ImGui::IsItemActive();
    a.area = {at.x, at.y, at.x + width, at.y + height};
    ui_mark(id, a.area);
    return a;
}

void part_changed(void) {
    ImGui::MarkItemEdited(ImGui::GetItemID());
}

bool *part_flag(const char *id, bool initial) {
    return ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID(id), initial);
}

void part_font_begin(font_kind kind) {
    ImGui::PushFont(ui.fonts[kind]);
}

void part_font_end(void) {
    ImGui::PopFont();
}

void part_popup_open(const char *id) {
    ImGui::OpenPopup(id);
}

bool part_popup_begin(const char *id) {
    if (!ImGui::BeginPopup(id)) return false;
    ui.depth++;
    return true;
}

void part_popup_end(void) {
    ui.depth--;
    ImGui::EndPopup();
}

bool part_button(const char *label, float width) {
    bool pressed = ImGui::Button(label, ImVec2(width, 0));
    mark_last(label);
    return pressed;
}

bool ui_small_button(const char *label) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(6 * ui.scale, 0));
    bool pressed = ImGui::Button(label);
    ImGui::PopStyleVar();
    return pressed;
}

bool ui_choice(const char *label, size_t *index, const char *const *words, size_t count) {
    bool changed = false;
    float width = part_row_begin(label), height = ImGui::GetFrameHeight();
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetNextItemWidth(width);
    const char *now = *index < count ? words[*index] : "";
    bool open = ImGui::BeginCombo("##value", now,
                                  ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLarge);
    for (size_t i = 0; open && i < count; i++) {
        ImGui::PushID((int)i);
        if (ImGui::Selectable(words[i], i == *index) && i != *index) {
            *index = i;
            changed = true;
        }
        mark_last(words[i]);
        if (i == *index) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
    }
    if (open) ImGui::EndCombo();
    draw_chevron(at.x + width - 13 * ui.scale, at.y + height / 2, true);
    part_row_end(label);
    return changed;
}

bool ui_input(const char *label, const char *hint, char *text, size_t capacity) {
    ImGui::SetNextItemWidth(part_row_begin(label));
    bool changed = ImGui::InputTextWithHint("##value", hint ? hint : "", text, capacity);
    part_row_end(label);
    return changed;
}

// ---- numbers ----------------------------------------------------------------------------------

// The text replaces the bar until Return or a click elsewhere; Escape keeps the old number.
static void bar_type(const ImRect &box, ImGuiID id, const char *name) {
    number_typing *t = &ui.typing;
    ImGui::TempInputText(box, id, name, t->text, (int)sizeof t->text,
                         ImGuiInputTextFlags_CharsScientific | ImGuiInputTextFlags_AutoSelectAll);
    if (!ImGui::TempInputIsActive(id)) number_type_leave(t);
}

static bool bar_drag(ImGuiID id, double *value, const number_range *range, float width) {
    static double exact; // where the pointer is; `value` is rounded
    ImGuiContext &g = *GImGui;
    if (g.ActiveId != id || g.ActiveIdSource != ImGuiInputSource_Mouse) return false;
    if (!g.IO.MouseDown[0]) {
        ImGui::ClearActiveID();
        return false;
    }
    if (g.ActiveIdIsJustActivated) exact = *value;
    float pixels = g.IO.MouseDelta.x * (g.IO.KeyShift ? 0.1f : 1);
    if (g.ActiveIdIsJustActivated || pixels == 0) return false;
    exact = number_drag(range, exact, (double)pixels, (double)width);
    double rounded = number_round(range, exact);
    if (rounded == *value) return false;
    *value = rounded;
    ImGui::MarkItemEdited(id);
    return true;
}

bool part_bar(const char *name, double *value, const number_range *range, const char *unit,
              float width) {
    ImGuiContext &g = *GImGui;
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    ImGuiID id = window->GetID(name);
    ImVec2 at = window->DC.CursorPos, size(width, ImGui::GetFrameHeight());
    ImRect box(at, ImVec2(at.x + size.x, at.y + size.y));
    ImGui::ItemSize(size, g.Style.FramePadding.y);
    if (!ImGui::ItemAdd(box, id, nullptr, ImGuiItemFlags_Inputable)) return false;
    bool hovered = ImGui::ItemHoverable(box, id), typing = ImGui::TempInputIsActive(id);
    bool tabbed = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) ||
                  g.NavActivateInputId == id;
    if (!typing && (tabbed || (hovered && g.IO.MouseClicked[0]))) {
        ImGui::SetActiveID(id, window);
        ImGui::SetFocusID(id, window);
        ImGui::FocusWindow(window);
        g.ActiveIdSource = ImGuiInputSource_Mouse;
        typing = tabbed || g.IO.KeyCtrl || g.IO.MouseDoubleClicked[0];
    }
    if (typing) {
        number_type_begin(&ui.typing, id, range, *value);
        bar_type(box, id, name);
        ui_mark("typed", {box.Min.x, box.Min.y, box.Max.x, box.Max.y});
        return number_type_take(&ui.typing, id, range, value);
    }
    if (ui.typing.id == id) number_type_leave(&ui.typing); // the pointer went elsewhere
    if (number_type_take(&ui.typing, id, range, value)) return true;
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    bool changed = bar_drag(id, value, range, width);
    show_focus(id, box.Min, box.Max);
    draw_bar({box.Min.x, box.Min.y, box.Max.x, box.Max.y}, *value, range, unit, hovered,
             g.ActiveId == id);
    return changed;
}

// ---- about the last widget --------------------------------------------------------------------

bool ui_active(void) {
    return ImGui::IsItemActive();
}

bool ui_hovered(void) {
    return ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled);
}

bool ui_menu_begin(const char *id) {
    return ImGui::BeginPopupContextItem(id);
}

void ui_menu_end(void) {
    ImGui::EndPopup();
}

bool ui_row(const char *label, bool chosen, bool dim) {
    if (dim) ImGui::PushStyleColor(ImGuiCol_Text, ui_rgba(UI_DIM, 1));
    bool clicked = ImGui::Selectable(label, chosen);
    if (dim) ImGui::PopStyleColor();
    mark_last(label);
    return clicked;
}

bool ui_item(const char *label) {
    bool chosen = ImGui::MenuItem(label);
    mark_last(label);
    return chosen;
}
