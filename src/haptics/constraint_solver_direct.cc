// The end of a step with few contacts: which of them stick, slide and let go is known, or nearly
// so, from the sweeps, and their forces are solved for at once. Two points that nearly wedge a
// shaft take thousands of sweeps otherwise.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "haptics/constraint_solver.h"

namespace hvas::haptics {
namespace {

constexpr std::size_t kMaxPressing = 6;  // Contacts: a choice, for the time that it takes.
// A normal and two tangents for each, and the bounded rows: room, not a choice.
constexpr std::size_t kMaxUnknowns = 3 * kMaxPressing + ConstraintSolver::kMaxBoundedRows;

/** Linear equations in fixed room, solved by elimination with partial pivoting. Eigen's would go
 through its blocked kernels, which allocate. */
class LinearEquations {
 public:
  void Resize(std::size_t size) noexcept { size_ = size; }

  double& at(std::size_t row, std::size_t column) noexcept { return a_[row][column]; }

  /** Right side of a row, and after Solve() the unknown of that number. */
  double& right(std::size_t row) noexcept { return a_[row][kMaxUnknowns]; }

  /** False where there is no one solution. */
  bool Solve() noexcept {
    constexpr double kSingular = 1e-12;  // Of the largest entry: what rounding leaves.
    double largest = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) {
        largest = std::max(largest, std::abs(a_[i][j]));
      }
    }
    for (std::size_t k = 0; k < size_; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < size_; ++i) {
        pivot = std::abs(a_[i][k]) > std::abs(a_[pivot][k]) ? i : pivot;
      }
      if (!(std::abs(a_[pivot][k]) > kSingular * largest)) {
        return false;
      }
      std::swap(a_[k], a_[pivot]);
      for (std::size_t i = k + 1; i < size_; ++i) {
        Subtract(k, a_[i][k] / a_[k][k], i);
      }
    }
    for (std::size_t k = size_; k-- > 0;) {
      for (std::size_t j = k + 1; j < size_; ++j) {
        right(k) -= a_[k][j] * right(j);
      }
      right(k) /= a_[k][k];
    }
    return true;
  }

 private:
  void Subtract(std::size_t k, double factor, std::size_t i) noexcept {
    for (std::size_t j = k; j < size_; ++j) {
      a_[i][j] -= factor * a_[k][j];
    }
    right(i) -= factor * right(k);
  }

  std::size_t size_{0};
  std::array<std::array<double, kMaxUnknowns + 1>, kMaxUnknowns> a_;
};

}  // namespace

/** Tries what the sweeps have found of each contact, and corrects it where the solution differs. */
class ConstraintSolver::DirectSolution {
 public:
  explicit DirectSolution(ConstraintSolver* solver) noexcept : solver_(*solver) {}

  /** Gives the solution to the solver, and true; false where it finds none, and nothing changes. */
  bool Find() noexcept {
    if (!Collect()) {
      return false;
    }
    constexpr int kRounds = 6;  // A choice: two suffice for what a tick changes.
    for (int round = 0; round < kRounds; ++round) {
      Assemble();
      if (!equations_.Solve()) {
        return false;
      }
      const Verdict verdict = Check();
      if (verdict == Verdict::kRight) {
        Commit();
      }
      if (verdict != Verdict::kWrong) {
        return verdict == Verdict::kRight;
      }
    }
    return false;
  }

 private:
  enum class Motion { kLetsGo, kSticks, kSlides };

  enum class Verdict { kRight, kWrong, kImpossible };

  /** A contact that pressed after the sweeps. */
  struct Pressing {
    std::size_t index{0};
    Motion motion{Motion::kSticks};
    double coefficient{0};
    double stick_softness{0};         ///< By its share of the load after the sweeps.
    Eigen::Vector2d friction{0, 0};   ///< Unit: where friction points while the contact slides.
    Eigen::Vector3d lambda{0, 0, 0};  ///< Solution: normal, and along both tangents [N s].
  };

  /** False where it is not for this class: other bodies move, rolling, or too many contacts. */
  bool Collect() noexcept {
    for (std::size_t i = 0; i < static_cast<std::size_t>(solver_.contact_count_); ++i) {
      ContactRows& rows = solver_.contacts_[i];
      const PatchRows& patch = solver_.patches_[static_cast<std::size_t>(rows.patch)];
      if (patch.of.body != 0 || patch.of.other != kWorld || patch.of.rolling_arm > 0) {
        return false;
      }
      if (rows.normal.lambda <= 0) {
        continue;
      }
      if (pressing_count_ == kMaxPressing) {
        return false;
      }
      if (!rows.is_prepared) {
        solver_.PrepareFriction(&rows);
      }
      pressing_[pressing_count_++] = Describe(i, rows, patch);
    }
    const auto is_of_another = [](std::size_t body) { return body != 0; };
    return pressing_count_ > 0 &&
           std::none_of(solver_.bounded_body_.begin(),
                        solver_.bounded_body_.begin() + solver_.bounded_count_, is_of_another);
  }

  static Pressing Describe(std::size_t index, const ContactRows& rows,
                           const PatchRows& patch) noexcept {
    constexpr double kAtTheLimit = 1 - 1e-6;  // Of what friction holds: what sweeps leave.
    Pressing pressing;
    pressing.index = index;
    pressing.coefficient = patch.of.coefficient;
    pressing.stick_softness = patch.stick_softness * patch.load / rows.normal.lambda;
    const Eigen::Vector2d friction(rows.tangent[0].lambda, rows.tangent[1].lambda);
    const double limit = patch.of.coefficient * rows.normal.lambda;
    if (friction.norm() >= kAtTheLimit * limit) {
      pressing.motion = Motion::kSlides;
      pressing.friction = limit > 0 ? Eigen::Vector2d(friction.normalized()) : friction;
    }
    return pressing;
  }

  void Add(const Row& row, const Vec6& effect, double softness) noexcept {
    rows_[size_] = &row;
    effects_[size_] = effect;
    softness_[size_++] = softness;
  }

  /** J V + softness lambda = bias for each row that is not at a bound, with V from all of them. */
  void Assemble() noexcept {
    size_ = 0;
    V_known_ = solver_.V_free_;
    for (std::size_t i = 0; i < static_cast<std::size_t>(solver_.bounded_count_); ++i) {
      const Row& row = solver_.bounded_[i];
      is_between_[i] = row.lambda > solver_.bounds_[i][0] && row.lambda < solver_.bounds_[i][1];
      if (is_between_[i]) {
        Add(row, row.W, row.softness);
      } else {
        V_known_ += row.lambda * row.W;
      }
    }
    for (std::size_t k = 0; k < pressing_count_; ++k) {
      const Pressing& pressing = pressing_[k];
      const ContactRows& rows = solver_.contacts_[pressing.index];
      Vec6 effect = rows.normal.W;
      if (pressing.motion == Motion::kSlides) {
        effect += pressing.coefficient * (pressing.friction.x() * rows.tangent[0].W +
                                          pressing.friction.y() * rows.tangent[1].W);
      }
      if (pressing.motion != Motion::kLetsGo) {
        Add(rows.normal, effect, rows.normal.softness);
      }
      if (pressing.motion == Motion::kSticks) {
        Add(rows.tangent[0], rows.tangent[0].W, pressing.stick_softness);
        Add(rows.tangent[1], rows.tangent[1].W, pressing.stick_softness);
      }
    }
    equations_.Resize(size_);
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) {
        equations_.at(i, j) = rows_[i]->J.dot(effects_[j]);
      }
      equations_.at(i, i) += softness_[i];
      equations_.right(i) = rows_[i]->bias - rows_[i]->J.dot(V_known_);
    }
  }

  /** Whether each contact does what it was taken to do; what it does instead is taken next. */
  Verdict Check() noexcept {
    V_ = V_known_;
    for (std::size_t i = 0; i < size_; ++i) {
      V_ += equations_.right(i) * effects_[i];
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(solver_.bounded_count_); ++i) {
      bounded_lambda_[i] = is_between_[i] ? equations_.right(next++) : solver_.bounded_[i].lambda;
      if (bounded_lambda_[i] < solver_.bounds_[i][0] ||
          bounded_lambda_[i] > solver_.bounds_[i][1]) {
        return Verdict::kImpossible;
      }
    }
    Verdict verdict = Verdict::kRight;
    for (std::size_t k = 0; k < pressing_count_; ++k) {
      const Verdict one = CheckContact(&next, &pressing_[k]);
      verdict = std::max(verdict, one);
    }
    return verdict == Verdict::kRight && !AreOthersApart() ? Verdict::kImpossible : verdict;
  }

  Verdict CheckContact(std::size_t* next, Pressing* pressing) noexcept {
    const ContactRows& rows = solver_.contacts_[pressing->index];
    pressing->lambda.setZero();
    if (pressing->motion == Motion::kLetsGo) {
      return rows.normal.J.dot(V_) < rows.normal.bias ? Verdict::kImpossible : Verdict::kRight;
    }
    const double normal = equations_.right((*next)++);
    if (pressing->motion == Motion::kSticks) {
      const double x = equations_.right((*next)++);
      pressing->lambda = {normal, x, equations_.right((*next)++)};
    } else {
      pressing->lambda << normal, pressing->coefficient * normal * pressing->friction;
    }
    if (normal < 0) {
      pressing->motion = Motion::kLetsGo;
      return Verdict::kWrong;
    }
    if (rows.normal.J.dot(V_) > rows.recovery_speed) {
      return Verdict::kImpossible;
    }
    return CheckFriction(rows, pressing);
  }

  Verdict CheckFriction(const ContactRows& rows, Pressing* pressing) const noexcept {
    constexpr double kSameDirection = 1e-9;  // Far below what is felt.
    const Eigen::Vector2d friction = pressing->lambda.tail<2>();
    if (pressing->motion == Motion::kSticks) {
      if (friction.norm() <= pressing->coefficient * pressing->lambda[0]) {
        return Verdict::kRight;
      }
      pressing->motion = Motion::kSlides;
      pressing->friction = friction.normalized();
      return Verdict::kWrong;
    }
    const Eigen::Vector2d slip = Eigen::Vector2d(rows.tangent[0].J.dot(V_) - rows.tangent[0].bias,
                                                 rows.tangent[1].J.dot(V_) - rows.tangent[1].bias) +
                                 pressing->stick_softness * friction;
    const double speed = slip.norm();
    if (speed <= 0 || pressing->coefficient <= 0) {
      return Verdict::kRight;
    }
    if (slip.dot(pressing->friction) >= 0) {
      pressing->motion = Motion::kSticks;
      return Verdict::kWrong;
    }
    const Eigen::Vector2d before = std::exchange(pressing->friction, -slip / speed);
    return (pressing->friction - before).norm() <= kSameDirection ? Verdict::kRight
                                                                  : Verdict::kWrong;
  }

  /** Contacts that did not press after the sweeps do not press now. */
  [[nodiscard]] bool AreOthersApart() const noexcept {
    constexpr double kNoise = 1e-12;  // [m/s]: what rounding leaves.
    return std::all_of(
        solver_.contacts_.begin(), solver_.contacts_.begin() + solver_.contact_count_,
        [this](const ContactRows& rows) {
          return rows.normal.lambda > 0 || rows.normal.J.dot(V_) >= rows.normal.bias - kNoise;
        });
  }

  void Commit() noexcept {
    solver_.V_[0] = V_;
    for (std::size_t i = 0; i < static_cast<std::size_t>(solver_.bounded_count_); ++i) {
      solver_.bounded_[i].lambda = bounded_lambda_[i];
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(solver_.patch_count_); ++i) {
      solver_.patches_[i].load = 0;
    }
    for (std::size_t k = 0; k < pressing_count_; ++k) {
      const Eigen::Vector3d& lambda = pressing_[k].lambda;
      ContactRows& rows = solver_.contacts_[pressing_[k].index];
      rows.normal.lambda = lambda[0];
      rows.tangent[0].lambda = lambda[1];
      rows.tangent[1].lambda = lambda[2];
      solver_.patches_[static_cast<std::size_t>(rows.patch)].load += lambda[0];
    }
  }

  ConstraintSolver& solver_;
  std::array<Pressing, kMaxPressing> pressing_;
  std::size_t pressing_count_{0};
  LinearEquations equations_;
  std::array<const Row*, kMaxUnknowns> rows_{};
  std::array<Vec6, kMaxUnknowns> effects_;
  std::array<double, kMaxUnknowns> softness_{};
  std::size_t size_{0};
  std::array<bool, kMaxBoundedRows> is_between_{};
  std::array<double, kMaxBoundedRows> bounded_lambda_{};
  Vec6 V_known_{Vec6::Zero()};  ///< With what the unknowns do left out.
  Vec6 V_{Vec6::Zero()};
};

bool ConstraintSolver::SolveDirectly() noexcept {
  return DirectSolution(this).Find();
}

}  // namespace hvas::haptics
