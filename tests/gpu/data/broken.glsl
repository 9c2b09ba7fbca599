// A user's mistake, for tests: the name of the variable is misspelt.
float broken(vec3 p) {
    return length(pp);
}
