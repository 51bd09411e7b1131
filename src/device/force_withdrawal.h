#pragma once

/** The end of a process must not leave a force on anybody's hand: whoever renders to a device is
 gone, and a device may hold what it was told last. */
namespace hvas::device {

class Device;

/** Lets LimitWrench() pass no force of this process from now on, and every open device is given
 zero. For a process that ends at once: nothing brings forces back. Waits for as long as the haptic
 threads and those of vendors need to hand it on. */
void WithdrawForces() noexcept;

[[nodiscard]] bool AreForcesWithdrawn() noexcept;

/** Withdraws forces before the process ends by std::terminate or by a signal that is not handled
 otherwise, writes a note where it crashes (base/crash_note.h), and then lets it end as it would
 have. To be called once, by main(). */
void WithdrawForcesAtTheEnd();

/** Adds a device to those whose forces WithdrawForces() withdraws. @returns false when 64 devices
 are open already. */
[[nodiscard]] bool NoteOpenDevice(Device* device) noexcept;
void ForgetDevice(const Device* device) noexcept;

}  // namespace hvas::device
