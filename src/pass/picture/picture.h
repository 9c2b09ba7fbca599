// The pass type `picture`: a file's numbers as an image, written once.
#pragma once
#include "pass/pass.h"

struct picture;
// Before pass_declare; the picture lives as long as the pass.
void pass_picture_open(pass *p, const struct picture *from);
