// A library that needs another one, which the loader does not find.

extern "C" int hvas_missing_dependency();

extern "C" __attribute__((visibility("default"))) int hvas_needs_dependency() {
  return hvas_missing_dependency();
}
