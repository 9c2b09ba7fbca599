void main() { float a = ; }
