/* Plug-ins that HVAS has to refuse; which one is said by ODD_PLUGIN. */
#include <stddef.h>

#include "hvas_device_plugin.h"

#ifdef ODD_PLUGIN_VERSION
const struct HvasDevicePlugin* hvas_device_plugin(uint32_t host_version) {
  static const struct HvasDevicePlugin plugin = {
      sizeof(struct HvasDevicePlugin), ODD_PLUGIN_VERSION, NULL, NULL, NULL, NULL, NULL};
  (void)host_version;
  return &plugin;
}
#else
int something_else(void);

int something_else(void) {
  return 1;
}
#endif
