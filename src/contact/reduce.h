#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "spatial/pose.h"

namespace hvas::contact {

/** RawContact::point of what is exact where it is found, and not moved from there. */
inline constexpr std::uint32_t kFixedPoint = 0xffffffffU;

/** A contact as it is found: a sample of one shape in the field of the other. Frames are centred.
 */
struct RawContact {
  double distance{0};
  Vec3 p{Vec3::Zero()};         ///< The sample, in the frame of the shape it belongs to.
  Vec3 gradient{Vec3::Zero()};  ///< Unit, out of the other shape, in that shape's frame.
  std::uint32_t body{0};
  std::uint32_t point{0};  ///< Index in the shell that it came from, or kFixedPoint.
  std::uint32_t held_face{0};
  std::uint32_t scene_face{0};
  std::uint32_t triangle{
      kFixedPoint};        ///< A triangle of the field's freeform face near it, or none.
  bool is_reverse{false};  ///< The sample is the scene body's, the field the held shape's.
  bool is_exact{false};
  bool is_screened{false};  ///< Distance and gradient are in single precision, to kScreened.
  bool is_rough{false};     ///< A better distance is to be had; see Refined.
  double allowance{0};      ///< What `distance` has more than the shapes' [m]; see Allowance.
  float sparsity{1};        ///< Samples of the shell for each one that was tested here.
};

/** Reduces a stream of contacts to a few that span it. Contacts are grouped by body, scene face and
 direction of the normal; each group keeps its deepest and its extremes along eight tangents, which
 for faces that touch flat are the corners of the contact. Fixed size, RT-safe. */
class ContactReducer {
 public:
  void Clear() noexcept;

  /** Keeps a contact if it is deeper than its group's deepest or beyond an extreme; a screened one
   by more than kDeeper or kFurther.
   @param nhat_S  The contact's normal in the scene body, which the groups go by.
   @param p_S  Its position there. */
  void Add(const RawContact& contact, const Vec3& nhat_S, const Vec3& p_S) noexcept;

  /** Writes the deepest of every group, deepest group first, then extremes, until `out` is full.
   Returns how many were written. */
  std::size_t Select(std::span<RawContact> out) noexcept;

  /** How many of the selected are a group's deepest; they come first. */
  [[nodiscard]] std::size_t group_count() const noexcept { return group_count_; }

  /** Returns the deepest of those that are not screened and of those that found no group [m]. */
  [[nodiscard]] double deepest() const noexcept { return deepest_; }

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }

  [[nodiscard]] bool is_full() const noexcept { return is_full_; }

 private:
  static constexpr double kDeeper = 20e-9;  ///< [m]: less is noise of the refined depths. A choice.
  static constexpr double kFurther = 10e-6;  ///< [m]: less changes no lever. A choice.
  // Groups of normals on all bodies; twice as many places of the hash table; directions in which a
  // group keeps its furthest contact, 45 degrees apart.
  static constexpr std::size_t kMaxGroups = 256;
  static constexpr std::size_t kSlots = 512;
  static constexpr std::size_t kTangents = 8;
  // A contact that a group keeps lies in one cell, whatever it is kept for. One cell more than the
  // group can keep: there is always a free one for the next.
  static constexpr std::size_t kCells = kTangents + 2;

  // What a contact is kept for: a bit for the deepest, and one for each tangent.
  using Roles = std::uint16_t;
  static constexpr Roles kDeepest = 1;

  // What is asked of a group for each contact; the contacts that it keeps are in cells_.
  struct Group {
    std::uint64_t key{0};
    Vec3 u{Vec3::Zero()};
    Vec3 v{Vec3::Zero()};
    double least{0};
    std::array<double, kTangents> reach{};
    std::array<Roles, kCells> roles{};  // Of the contacts in its cells; 0: the cell is free.

    void Clear() noexcept;
    [[nodiscard]] std::size_t FreeCell() const noexcept;
    /** Gives roles to the contact in a cell, which takes them from the others. */
    void Give(Roles taken, std::size_t cell) noexcept;
    /** The cell of the contact that has a role. */
    [[nodiscard]] std::size_t CellOf(Roles role) const noexcept;
  };

  /** Slot of the key: of its group, or where it would go. */
  [[nodiscard]] std::size_t SlotOf(std::uint64_t key) const noexcept;
  /** Number of the key's group; kMaxGroups where there is no room for it. */
  std::size_t Find(std::uint64_t key, const Vec3& nhat_S) noexcept;

  std::array<Group, kMaxGroups> groups_;
  std::array<std::array<RawContact, kCells>, kMaxGroups> cells_;
  std::array<std::uint16_t, kSlots> slots_{};  // Group number + 1.
  std::size_t group_count_{0};
  std::uint32_t count_{0};
  double deepest_{0};
  bool is_full_{false};
};

}  // namespace hvas::contact
