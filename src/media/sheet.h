// Sheets: the frames of an effect beside each other in one picture, as cells of a flipbook, left to
// right and top to bottom. Pictures of floats, four channels a pixel, rows from the top.
#pragma once
#include <stdint.h>

typedef struct sheet {
    uint32_t columns, rows;
    uint32_t width, height; // of a cell, pixels
    float *pixels;          // columns * width by rows * height
} sheet;

typedef struct sheet_area { // of a cell, in pixels: from, and up to
    uint32_t left, top, right, bottom;
} sheet_area;

// All zero. Free it with sheet_free.
sheet sheet_create(uint32_t columns, uint32_t rows, uint32_t width, uint32_t height);
void sheet_free(sheet *s);
float *sheet_pixel(const sheet *s, uint32_t cell, uint32_t x, uint32_t y); // of a cell
// Adds a picture of a cell's size, times a weight.
void sheet_add(sheet *s, uint32_t cell, const float *picture, float weight);

// Returns the smallest area of all cells outside of which no channel up to `channels` of any is
// above `least`; empty when none is.
sheet_area sheet_find_used(const sheet *s, float least, int channels);
sheet_area sheet_find_used_in(const sheet *s, uint32_t cell, float least, int channels); // of one
// Cuts every cell to an area, which lies in it.
void sheet_crop(sheet *s, sheet_area area);

// Divides the colours of each pixel by its alpha, where that is above 1e-4; elsewhere they become
// 0.
void sheet_unpremultiply(sheet *s);
// Fills the pixels of each cell whose alpha is no more than `least`, colours but not alpha, with
// those around them, so that filters and mip levels mix them with their like: from coarser and
// coarser means of those that are known (Gortler et al., "The lumigraph", 1996, section 3.4.3: pull
// and push). A cell without any stays as it is.
void sheet_fill(sheet *s, float least);
