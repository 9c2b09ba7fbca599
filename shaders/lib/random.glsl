// Counter-based randomness: the same seed, frame and pixel give the same number.

// PCG hash by Jarzynski and Olano (JCGT 9(3), 2020).
uint random_hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float random_pixel(uvec2 pixel, uint seed) {
    return float(random_hash(pixel.x + random_hash(pixel.y + random_hash(seed)))) * (1.0 / 4294967296.0);
}
