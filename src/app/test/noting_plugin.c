/* A device whose handle stands still below its floor, and that notes each write with its time in
   the file that is its argument: pairs of doubles, [s] and [N]. */
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "hvas_device_plugin.h"

static const double kDepth = 0.03; /* [m] */

struct Handle {
  int file;
};

static void* Open(const char* argument, char* error, uint32_t error_size) {
  struct Handle* handle = calloc(1, sizeof(struct Handle));
  if (handle == NULL) {
    return NULL;
  }
  handle->file = open(argument, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (handle->file < 0) {
    snprintf(error, error_size, "the file \"%s\" cannot be written", argument);
    free(handle);
    return NULL;
  }
  return handle;
}

static void Close(void* device) {
  struct Handle* handle = device;
  close(handle->file);
  free(handle);
}

static void Describe(void* device, struct HvasDeviceDescription* description) {
  (void)device;
  description->flags = HVAS_DEVICE_IS_EMULATED;
  description->force_axes = 3;
  description->button_count = 1;
  snprintf(description->model, sizeof description->model, "Noting handle");
  description->max_force = 8;
  description->continuous_force = 8;
}

static int32_t Read(void* device, struct HvasDeviceSample* sample) {
  (void)device;
  sample->position[2] = -kDepth;
  return HVAS_DEVICE_READY;
}

static void Write(void* device, const struct HvasDeviceWrench* wrench) {
  const struct Handle* handle = device;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double* f = wrench->force;
  const double note[2] = {(double)now.tv_sec + 1e-9 * (double)now.tv_nsec,
                          sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2])};
  if (write(handle->file, note, sizeof note) != (ssize_t)sizeof note) {
    abort();
  }
}

const struct HvasDevicePlugin* hvas_device_plugin(uint32_t host_version) {
  static const struct HvasDevicePlugin plugin = {sizeof(struct HvasDevicePlugin),
                                                 HVAS_DEVICE_PLUGIN_VERSION,
                                                 Open,
                                                 Close,
                                                 Describe,
                                                 Read,
                                                 Write};
  (void)host_version;
  return &plugin;
}
