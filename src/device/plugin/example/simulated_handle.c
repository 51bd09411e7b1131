/* An example of a plug-in: a handle of some mass that slides with friction, moved by nothing but
   the force that HVAS gives it. Each read() is one millisecond. A plug-in for a real device asks
   its encoders instead.

   Argument: the handle's mass in kg, 0.1 when there is none. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hvas_device_plugin.h"

static const double kStep_s = 1e-3;
static const double kDamping = 2.0;   /* [N s/m] */
static const double kMaxForce = 5.0;  /* [N] */
static const int kWatchdogReads = 20; /* without a write(), the force goes to zero */

struct Handle {
  double mass; /* [kg] */
  double position[3];
  double velocity[3];
  double force[3];
  int reads_since_write;
};

static void* Open(const char* argument, char* error, uint32_t error_size) {
  double mass = 0.1;
  if (argument[0] != '\0') {
    char* end = NULL;
    mass = strtod(argument, &end);
    if (*end != '\0' || !(mass >= 0.01 && mass <= 10)) {
      snprintf(error, error_size,
               "the mass \"%s\" is none; give one of 0.01 to 10 kg, as in plugin:FILE?0.2",
               argument);
      return NULL;
    }
  }
  struct Handle* handle = calloc(1, sizeof(struct Handle));
  if (handle == NULL) {
    snprintf(error, error_size, "there is no memory left");
    return NULL;
  }
  handle->mass = mass;
  return handle;
}

static void Close(void* device) {
  free(device);
}

static void Describe(void* device, struct HvasDeviceDescription* description) {
  (void)device;
  description->flags = HVAS_DEVICE_IS_EMULATED;
  description->force_axes = 3;
  description->torque_axes = 0;
  description->button_count = 1;
  snprintf(description->model, sizeof description->model, "Simulated handle");
  snprintf(description->serial, sizeof description->serial, "EMULATED-1");
  snprintf(description->version, sizeof description->version, "1");
  description->max_force = kMaxForce;
  description->continuous_force = kMaxForce;
}

static int32_t Read(void* device, struct HvasDeviceSample* sample) {
  struct Handle* handle = device;
  if (handle->reads_since_write++ >= kWatchdogReads) {
    memset(handle->force, 0, sizeof handle->force);
  }
  for (int k = 0; k < 3; ++k) {
    const double force = handle->force[k] - kDamping * handle->velocity[k];
    handle->velocity[k] += kStep_s / handle->mass * force;
    handle->position[k] += kStep_s * handle->velocity[k];
    sample->position[k] = handle->position[k];
    sample->velocity[k] = handle->velocity[k];
  }
  sample->orientation[0] = 1;
  return HVAS_DEVICE_READY;
}

static void Write(void* device, const struct HvasDeviceWrench* wrench) {
  struct Handle* handle = device;
  memcpy(handle->force, wrench->force, sizeof handle->force);
  handle->reads_since_write = 0;
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
