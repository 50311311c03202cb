/* For the build with sanitizers only: drivers stay loaded until the end, or the leak checker couldn't tell their
 * memory, which is theirs to keep, from ours. */
__attribute__((visibility("default"))) int dlclose(void* module) {
    (void)module;
    return 0;
}
