// What stub_needy needs; the build puts it where the loader does not look.

extern "C" __attribute__((visibility("default"))) int hvas_missing_dependency() {
  return 1;
}
