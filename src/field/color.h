// Colour spaces that palettes mix in, and the colour of hot bodies.
#pragma once

void color_to_oklab(const float linear[3], float lab[3]);   // from linear Rec.709, any brightness
void color_from_oklab(const float lab[3], float linear[3]); // may leave the gamut: negative values
