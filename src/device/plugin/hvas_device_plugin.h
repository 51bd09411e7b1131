/* A device that HVAS does not know, as a shared library. Plain C; docs/devices/plugin.md explains
   it.

   The library exports one function, hvas_device_plugin(), that returns a table of functions. HVAS
   calls them for one device from one thread at a time; several devices may be open at once.
   Units are SI: m, rad, s, N, N m. The frame D of the device: x to the right, y away from the
   person, z up. */
#ifndef HVAS_DEVICE_PLUGIN_H
#define HVAS_DEVICE_PLUGIN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this header. It changes when something that is here changes its meaning or its place; new
   members are added at the end of a struct, and `size` tells whether they are there. */
#define HVAS_DEVICE_PLUGIN_VERSION 1u

/* NOLINTBEGIN(readability-identifier-naming): names as is usual in C. */
/* What read() found. In all but the first, HVAS gives no force. */
enum HvasDeviceStatus {
  HVAS_DEVICE_READY = 0,          /* a new sample; force is shown */
  HVAS_DEVICE_NO_NEW_SAMPLE = 1,  /* the one before is the newest */
  HVAS_DEVICE_NO_FORCE = 2,       /* a new sample, but the motors are off */
  HVAS_DEVICE_NOT_HELD = 3,       /* a new sample, but nobody holds the handle */
  HVAS_DEVICE_NOT_CALIBRATED = 4, /* its pose is not to be trusted */
  HVAS_DEVICE_LOST = 5,           /* unplugged; the plug-in keeps trying */
  HVAS_DEVICE_STOPPED = 6,        /* emergency stop */
  HVAS_DEVICE_FAULT = 7           /* anything else; vendor_code says what */
};

/* Bits of HvasDeviceDescription.flags. */
enum HvasDeviceFlags {
  HVAS_DEVICE_SENSES_ROTATION = 1,
  HVAS_DEVICE_HAS_GRIP = 2,
  HVAS_DEVICE_HAS_PRESENCE_SWITCH = 4,
  HVAS_DEVICE_HAS_EMERGENCY_STOP = 8,
  HVAS_DEVICE_IS_EMULATED = 16
};

/* NOLINTEND(readability-identifier-naming) */

/* What a device is and can do. HVAS fills it with its defaults first: leave alone what you do not
   know. */
struct HvasDeviceDescription {
  uint32_t size; /* of this struct, set by HVAS */
  uint32_t flags;
  uint32_t force_axes;  /* 0 or 3 */
  uint32_t torque_axes; /* 0 or 3 */
  uint32_t button_count;
  uint32_t reserved;
  char model[64]; /* texts end with a zero byte */
  char serial[64];
  char version[32];
  double max_force;         /* peak [N] */
  double continuous_force;  /* [N] */
  double max_torque;        /* [N m] */
  double continuous_torque; /* [N m] */
  double max_stiffness;     /* that it renders stably at 1 kHz [N/m] */
  double max_damping;       /* [N s/m] */
  double max_rotational_stiffness;
  double max_rotational_damping;
  double position_resolution; /* [m] */
  double rotation_resolution; /* [rad] */
  double workspace[3];        /* edges of the usable box round the origin of D [m] */
  double rate_hz;
  double delay; /* from a sample to the force that answers it [s] */
};

struct HvasDeviceSample {
  uint32_t size;              /* of this struct, set by HVAS */
  uint32_t buttons;           /* bit 0 takes a part, bit 1 moves the workspace */
  double position[3];         /* of the handle's point in D [m] */
  double orientation[4];      /* unit quaternion w, x, y, z; 1, 0, 0, 0 when there is none */
  double velocity[3];         /* [m/s] */
  double angular_velocity[3]; /* in D [rad/s] */
  double grip;                /* 0 open .. 1 closed */
  int32_t vendor_code;        /* what the device's own software said last; 0: nothing */
  uint32_t reserved;
};

struct HvasDeviceWrench {
  double torque[3]; /* on the hand about the handle's point, in D [N m] */
  double force[3];  /* [N] */
};

struct HvasDevicePlugin {
  uint32_t size;    /* sizeof(struct HvasDevicePlugin) */
  uint32_t version; /* HVAS_DEVICE_PLUGIN_VERSION of the header that it was built with */

  /* Opens the device that `argument` names (what follows the question mark of the address; may be
     empty), without force. Returns null and writes why, and what to do about it, to `error`
     otherwise: a text with a zero byte, `error_size` bytes at most. May take its time. */
  void* (*open)(const char* argument, char* error, uint32_t error_size);

  /* Switches the force off and lets go. */
  void (*close)(void* device);

  void (*describe)(void* device, struct HvasDeviceDescription* description);

  /* The newest sample; returns an HvasDeviceStatus. Called every millisecond from a real-time
     thread: never waits, never allocates. A device that was lost is looked for by a thread of the
     plug-in's own. */
  int32_t (*read)(void* device, struct HvasDeviceSample* sample);

  /* The wrench to show from now on. As read(). When write() is not called for 20 ms the plug-in
     lets the force go to zero by itself. */
  void (*write)(void* device, const struct HvasDeviceWrench* wrench);
};

/* The one function that a plug-in exports. `host_version` is the HVAS_DEVICE_PLUGIN_VERSION of
   HVAS; a plug-in that cannot do with it returns its table all the same, and HVAS tells. */
const struct HvasDevicePlugin* hvas_device_plugin(uint32_t host_version);

#ifdef __cplusplus
}
#endif

#endif
