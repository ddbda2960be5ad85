// Exists to be compiled with the precompiled GoogleTest headers that every test program reuses.
