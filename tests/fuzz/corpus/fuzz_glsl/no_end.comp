#if 1
void main() {
