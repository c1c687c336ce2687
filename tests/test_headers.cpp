// Nothing: the headers that CMake precompiles for the tests belong to some source file.
