// A picture from a file, as image "sprites/spark.png" gives it wherever a pass takes an image.
//
// Of a PNG, whose colours are sRGB, they become linear; its opacity is not in its colours.
writeonly uniform image2D color; //= output rgba16f : the picture: colour, and opacity
void main() {}
