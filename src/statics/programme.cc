#include "statics/programme.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

#include <ClpSimplex.hpp>

namespace hvas::statics {
namespace {

// A body lighter than this share of the heaviest one counts with this share where weights are
// units: so the numbers of the programme stay within what doubles resolve. Parts of 0.1 g beside
// parts of 100 kg are 1e-6. A choice.
constexpr double kLightest = 1e-7;
// CLP's tolerances of rows and of reduced costs; the tolerance of a row is a thousand of these, so
// that CLP's rounding decides nothing. CLP's own default is 1e-7.
constexpr double kClpTolerance = 1e-9;
// Sum of holds, in weights, up to which nothing needs to be held; a hundred times CLP's tolerance.
// A choice.
constexpr double kNoHold = 1e-7;
// A body whose velocity in the proof is below this does not move in it; it is at most 1 where a
// body falls by itself. A choice, a hundred times CLP's tolerance.
constexpr double kNoMotion = 1e-7;
// An edge of a pyramid whose power in the proof is above minus this adds nothing: as small as
// CLP's tolerance. A choice.
constexpr double kNoGain = 1e-9;
// Elements of a column that are below this are zero but for rounding. A choice.
constexpr double kNoElement = 1e-13;
// Pivots for each row and column of a programme after which CLP gives up. A choice, about ten times
// what programmes of assemblies take.
constexpr int kPivotsEach = 20;

using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kRows = 6;  // Equations of a body: three of force, three of torque.

/** What stands for a column in the problem. */
enum class ColumnKind { kContact, kJoint, kHold };

struct Column {
  ColumnKind kind;
  std::size_t index;  // Index of the contact, joint, or body.
  Vec3 force_W;       // Force of a column of value 1 [N].
  Vec3 torque_W;      // Torque about the joint's point, or the body's centre of mass [N m].
};

/** A contact of the programme, with the edges of its pyramid that have no column yet. */
struct Pricing {
  int contact;
  std::vector<Vec3> edges_W;
};

std::size_t FindRoot(std::vector<std::size_t>* parents, std::size_t i) {
  while ((*parents)[i] != i) {
    i = (*parents)[i] = (*parents)[(*parents)[i]];
  }
  return i;
}

}  // namespace

struct Programme::Data {
  const StaticProblem& problem;
  StaticOptions options;
  std::vector<std::ptrdiff_t> first_row;  // Of each body; -1: it is fixed.
  std::vector<double> weight;             // Unit of force of each body [N].
  std::vector<double> size;               // Unit of length of each body [m].
  std::vector<Pricing> pricings;
  std::vector<Column> columns;
  // Columns that are not in the model yet.
  std::vector<CoinBigIndex> starts{0};
  std::vector<int> rows;
  std::vector<double> elements;
  std::vector<double> low, high, costs;  // Bounds and costs.
  std::vector<double> gravity;           // Right-hand sides.
  ClpSimplex model;
  bool is_solved{false};

  Data(const StaticProblem& p, const StaticOptions& o) : problem(p), options(o) {}

  [[nodiscard]] bool IsFree(int body) const {
    return body != kGround && first_row[static_cast<std::size_t>(body)] >= 0;
  }

  void MeasureBodies();
  void AppendForce(int body, double sign, const Vec3& p_W, const Vec3& force_W,
                   const Vec3& torque_W);
  void EndColumn(const Column& column, double lowest, double highest, double cost);
  void AddEdge(int contact, const Vec3& edge_W);
  void AddContacts();
  /** Adds the edge of each contact that gains most in the last answer; false where none gains. */
  bool AddGainingEdges();
  void AddJoints();
  void AddHolds();
  void Load();
  void LoadColumns();
  /** Solves it with the columns that there are. */
  [[nodiscard]] Result<void> Optimise();
  [[nodiscard]] double CalcUnit(int a, int b) const;
  [[nodiscard]] Equilibrium ReadForces() const;
  /** Velocities of the proof in the units of the rows; zero for a fixed body. */
  [[nodiscard]] std::vector<Vec6> ReadMotions() const;
};

void Programme::Data::MeasureBodies() {
  const std::size_t count = problem.bodies.size();
  const double g = problem.g_W.norm();
  double heaviest = 0;
  for (const StaticBody& body : problem.bodies) {
    heaviest = body.is_fixed ? heaviest : std::max(heaviest, body.mass * g);
  }
  first_row.assign(count, -1);
  weight.assign(count, 0);
  size.assign(count, 0);
  std::ptrdiff_t row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    weight[i] = std::max(problem.bodies[i].mass * g, kLightest * heaviest);
    if (!problem.bodies[i].is_fixed) {
      first_row[i] = row;
      row += kRows;
    }
  }
  const auto reach = [&](int body, const Vec3& p_W) {
    if (body != kGround) {
      const auto i = static_cast<std::size_t>(body);
      size[i] = std::max(size[i], (p_W - problem.bodies[i].p_WC).norm());
    }
  };
  for (const StaticContact& contact : problem.contacts) {
    reach(contact.a, contact.p_W);
    reach(contact.b, contact.p_W);
  }
  for (const StaticJoint& joint : problem.joints) {
    reach(joint.a, joint.p_W);
    reach(joint.b, joint.p_W);
  }
  for (double& length : size) {
    length = length > 0 ? length : 1;  // Nothing turns a body that touches nothing.
  }
}

/** Adds what a force at a point, and a torque, do to a body. */
void Programme::Data::AppendForce(int body, double sign, const Vec3& p_W, const Vec3& force_W,
                                  const Vec3& torque_W) {
  if (!IsFree(body)) {
    return;
  }
  const auto i = static_cast<std::size_t>(body);
  const Vec3 f = sign * force_W / weight[i];
  const Vec3 t =
      sign * ((p_W - problem.bodies[i].p_WC).cross(force_W) + torque_W) / (weight[i] * size[i]);
  const std::array<double, kRows> values{f.x(), f.y(), f.z(), t.x(), t.y(), t.z()};
  for (std::size_t k = 0; k < kRows; ++k) {
    if (std::abs(values[k]) > kNoElement) {
      rows.push_back(static_cast<int>(first_row[i]) + static_cast<int>(k));
      elements.push_back(values[k]);
    }
  }
}

void Programme::Data::EndColumn(const Column& column, double lowest, double highest, double cost) {
  columns.push_back(column);
  starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  low.push_back(lowest);
  high.push_back(highest);
  costs.push_back(cost);
}

/** Unit of the forces between two bodies: the weight of the lighter one that is free [N]. */
double Programme::Data::CalcUnit(int a, int b) const {
  double unit = COIN_DBL_MAX;
  for (const int body : {a, b}) {
    if (IsFree(body)) {
      unit = std::min(unit, weight[static_cast<std::size_t>(body)]);
    }
  }
  return unit;
}

void Programme::Data::AddEdge(int contact, const Vec3& edge_W) {
  const auto index = static_cast<std::size_t>(contact);
  const StaticContact& at = problem.contacts[index];
  const Vec3 force_W = CalcUnit(at.a, at.b) * edge_W;
  AppendForce(at.a, 1, at.p_W, force_W, Vec3::Zero());
  AppendForce(at.b, -1, at.p_W, force_W, Vec3::Zero());
  EndColumn({ColumnKind::kContact, index, force_W, Vec3::Zero()}, 0, COIN_DBL_MAX, 0);
}

/** Adds the normals, which are within the pyramids; their edges follow where they are of use. */
void Programme::Data::AddContacts() {
  for (const int index : ListSpanningContacts(problem.contacts)) {
    const StaticContact& contact = problem.contacts[static_cast<std::size_t>(index)];
    if (!IsFree(contact.a) && !IsFree(contact.b)) {
      continue;
    }
    AddEdge(index, contact.nhat_W);
    if (contact.friction > 0) {
      pricings.push_back({index, ListPyramidEdges(contact, problem.g_W)});
    }
  }
}

bool Programme::Data::AddGainingEdges() {
  const std::vector<Vec6> motions = ReadMotions();
  // Velocity of a point of a body in the units of the rows, for the power of a force there.
  const auto velocity = [&](int body, const Vec3& p_W) -> Vec3 {
    if (!IsFree(body)) {
      return Vec3::Zero();
    }
    const auto i = static_cast<std::size_t>(body);
    const Vec3 turning = motions[i].tail<3>() / size[i];
    return (motions[i].head<3>() + turning.cross(p_W - problem.bodies[i].p_WC)) / weight[i];
  };
  bool has_gain = false;
  for (Pricing& pricing : pricings) {
    const StaticContact& contact = problem.contacts[static_cast<std::size_t>(pricing.contact)];
    const Vec3 v_W = CalcUnit(contact.a, contact.b) *
                     (velocity(contact.a, contact.p_W) - velocity(contact.b, contact.p_W));
    const auto best =
        std::min_element(pricing.edges_W.begin(), pricing.edges_W.end(),
                         [&v_W](const Vec3& p, const Vec3& q) { return p.dot(v_W) < q.dot(v_W); });
    if (best != pricing.edges_W.end() && best->dot(v_W) < -kNoGain) {
      AddEdge(pricing.contact, *best);
      pricing.edges_W.erase(best);
      has_gain = true;
    }
  }
  return has_gain;
}

void Programme::Data::AddJoints() {
  for (std::size_t index = 0; index < problem.joints.size(); ++index) {
    const StaticJoint& joint = problem.joints[index];
    if (!IsFree(joint.a) && !IsFree(joint.b)) {
      continue;
    }
    const double unit = CalcUnit(joint.a, joint.b);
    const double length = size[static_cast<std::size_t>(IsFree(joint.a) ? joint.a : joint.b)];
    const Vec3 u = joint.axis_W.unitOrthogonal();
    const std::array<Vec3, 3> directions{joint.axis_W, u, joint.axis_W.cross(u)};
    for (std::size_t k = 0; k < 2 * directions.size(); ++k) {
      const bool is_force = k < directions.size();
      const Vec3& direction = directions[k % directions.size()];
      const Vec3 force_W = is_force ? Vec3(unit * direction) : Vec3::Zero();
      const Vec3 torque_W = is_force ? Vec3::Zero() : Vec3(unit * length * direction);
      double limit = COIN_DBL_MAX;
      if (k == 0 && std::isfinite(joint.pull_out)) {
        limit = joint.pull_out / unit;
      }
      if (k == directions.size() && std::isfinite(joint.torque)) {
        limit = joint.torque / (unit * length);
      }
      AppendForce(joint.a, 1, joint.p_W, force_W, torque_W);
      AppendForce(joint.b, -1, joint.p_W, force_W, torque_W);
      EndColumn({ColumnKind::kJoint, index, force_W, torque_W}, -limit, limit, 0);
    }
  }
}

void Programme::Data::AddHolds() {
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    if (first_row[i] < 0) {
      continue;
    }
    for (std::size_t k = 0; k < kRows; ++k) {
      const Vec3 direction = Vec3::Unit(static_cast<Eigen::Index>(k % 3));
      for (const double sign : {1.0, -1.0}) {
        const Vec3 force_W = k < 3 ? Vec3(sign * weight[i] * direction) : Vec3::Zero();
        const Vec3 torque_W = k < 3 ? Vec3::Zero() : Vec3(sign * weight[i] * size[i] * direction);
        rows.push_back(static_cast<int>(first_row[i]) + static_cast<int>(k));
        elements.push_back(sign);
        EndColumn({ColumnKind::kHold, i, force_W, torque_W}, 0, COIN_DBL_MAX, 1);
      }
    }
  }
}

void Programme::Data::LoadColumns() {
  model.addColumns(static_cast<int>(low.size()), low.data(), high.data(), costs.data(),
                   starts.data(), rows.data(), elements.data());
  starts.assign(1, 0);
  rows.clear();
  elements.clear();
  low.clear();
  high.clear();
  costs.clear();
}

void Programme::Data::Load() {
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    if (first_row[i] >= 0) {
      const Vec3 force = -problem.bodies[i].mass * problem.g_W / weight[i];
      gravity.insert(gravity.end(), {force.x(), force.y(), force.z(), 0, 0, 0});
    }
  }
  model.setLogLevel(0);
  model.setPrimalTolerance(kClpTolerance);
  model.setDualTolerance(kClpTolerance);
  model.resize(static_cast<int>(gravity.size()), 0);
  for (std::size_t row = 0; row < gravity.size(); ++row) {
    model.setRowBounds(static_cast<int>(row), gravity[row] - options.tolerance,
                       gravity[row] + options.tolerance);
  }
  LoadColumns();
}

Equilibrium Programme::Data::ReadForces() const {
  Equilibrium found;
  found.contact_forces_W.assign(problem.contacts.size(), Vec3::Zero());
  found.joint_wrenches_W.assign(problem.joints.size(), {});
  found.hold_wrenches_W.assign(problem.bodies.size(), {});
  found.moves.assign(problem.bodies.size(), false);
  found.motions_W.assign(problem.bodies.size(), {});
  const double* values = model.primalColumnSolution();
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const Column& column = columns[j];
    const double value = std::clamp(values[j], model.columnLower()[j], model.columnUpper()[j]);
    const spatial::Wrench wrench{value * column.torque_W, value * column.force_W};
    switch (column.kind) {
      case ColumnKind::kContact:
        found.contact_forces_W[column.index] += wrench.f;
        break;
      case ColumnKind::kJoint:
        found.joint_wrenches_W[column.index] += wrench;
        break;
      case ColumnKind::kHold:
        found.hold_wrenches_W[column.index] += wrench;
        break;
    }
  }
  return found;
}

std::vector<Vec6> Programme::Data::ReadMotions() const {
  std::vector<Vec6> motions(problem.bodies.size(), Vec6::Zero());
  const double* duals = model.dualRowSolution();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (first_row[i] >= 0) {
      // The dual values are those of what has to be added to gravity, so the motion is against
      // them.
      motions[i] = -Eigen::Map<const Vec6>(duals + first_row[i]);
    }
  }
  return motions;
}

Result<void> Programme::Data::Optimise() {
  if (!low.empty()) {
    LoadColumns();
  }
  model.setMaximumIterations(kPivotsEach * static_cast<int>(gravity.size() + columns.size()));
  try {
    // The first basis is dual feasible. With new columns or other costs, the last one is primal
    // feasible.
    const int status = is_solved ? model.primal() : model.dual();
    if (status != 0) {
      model.allSlackBasis(true);
      model.dual();
    }
  } catch (const CoinError& error) {
    return Fail(ErrorCode::kInternal, "CLP: " + error.message(), "statics");
  }
  if (model.status() != 0) {
    return Fail(ErrorCode::kInternal,
                "the linear programme of the forces ended with CLP's status " +
                    std::to_string(model.status()),
                "statics");
  }
  is_solved = true;
  return {};
}

Programme::Programme(const StaticProblem& problem, const StaticOptions& options)
    : data_(std::make_unique<Data>(problem, options)) {
  data_->MeasureBodies();
  data_->AddContacts();
  data_->AddJoints();
  data_->AddHolds();
  data_->Load();
}

Programme::~Programme() = default;

Result<Equilibrium> Programme::Solve(const std::vector<bool>& is_held) {
  Data& data = *data_;
  const std::size_t count = data.problem.bodies.size();
  groups_.clear();
  hold_sizes_.assign(count, 0);
  if (data.gravity.empty()) {
    Equilibrium found;
    found.stands = true;
    found.contact_forces_W.assign(data.problem.contacts.size(), Vec3::Zero());
    found.joint_wrenches_W.assign(data.problem.joints.size(), {});
    found.hold_wrenches_W.assign(count, {});
    found.moves.assign(count, false);
    found.motions_W.assign(count, {});
    return found;
  }
  for (std::size_t j = 0; j < data.columns.size(); ++j) {
    if (data.columns[j].kind == ColumnKind::kHold) {
      const double cost = is_held[data.columns[j].index] ? 0 : 1;
      data.model.setObjectiveCoefficient(static_cast<int>(j), cost);
    }
  }
  do {
    if (auto optimised = data.Optimise(); !optimised) {
      return Unexpected(optimised.error());
    }
  } while (data.model.objectiveValue() > kNoHold && data.AddGainingEdges());

  Equilibrium found = data.ReadForces();
  double held = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const spatial::Wrench& hold = found.hold_wrenches_W[i];
    hold_sizes_[i] =
        hold.f.lpNorm<1>() / data.weight[i] + hold.t.lpNorm<1>() / (data.weight[i] * data.size[i]);
    held += is_held[i] ? 0 : hold_sizes_[i];
  }
  const std::vector<spatial::Wrench> resultants = CalcResultants(data.problem, found);
  for (std::size_t i = 0; i < count; ++i) {
    if (data.first_row[i] >= 0) {
      found.residual =
          std::max({found.residual, resultants[i].f.lpNorm<Eigen::Infinity>() / data.weight[i],
                    resultants[i].t.lpNorm<Eigen::Infinity>() / (data.weight[i] * data.size[i])});
    }
  }
  found.stands = held <= kNoHold;
  if (!found.stands) {
    AddProof(is_held, &found);
  }
  return found;
}

void Programme::AddProof(const std::vector<bool>& is_held, Equilibrium* found) {
  const Data& data = *data_;
  const std::size_t count = data.problem.bodies.size();
  const std::vector<Vec6> motions = data.ReadMotions();
  std::vector<std::size_t> parents(count);
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  const auto is_moving = [&](int body) {
    return data.IsFree(body) && !is_held[static_cast<std::size_t>(body)] &&
           motions[static_cast<std::size_t>(body)].lpNorm<Eigen::Infinity>() > kNoMotion;
  };
  const auto unite = [&](int a, int b) {
    if (is_moving(a) && is_moving(b)) {
      const std::size_t root_a = FindRoot(&parents, static_cast<std::size_t>(a));
      const std::size_t root_b = FindRoot(&parents, static_cast<std::size_t>(b));
      parents[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }
  };
  for (const StaticContact& contact : data.problem.contacts) {
    unite(contact.a, contact.b);
  }
  for (const StaticJoint& joint : data.problem.joints) {
    unite(joint.a, joint.b);
  }
  std::vector<std::vector<int>> groups(count);
  std::vector<double> powers(count, 0);
  double lightest = COIN_DBL_MAX;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_moving(static_cast<int>(i))) {
      const std::size_t root = FindRoot(&parents, i);
      groups[root].push_back(static_cast<int>(i));
      const Vec3 pull = data.problem.bodies[i].mass * data.problem.g_W / data.weight[i];
      powers[root] +=
          motions[i].head<3>().dot(pull) - data.options.tolerance * motions[i].lpNorm<1>();
      lightest = std::min(lightest, data.weight[i]);
    }
  }
  for (std::size_t root = 0; root < count; ++root) {
    if (powers[root] <= 0) {  // Rounding: nothing that moves without power is left in the optimum.
      continue;
    }
    for (const int body : groups[root]) {
      const auto i = static_cast<std::size_t>(body);
      const double scale = lightest / data.weight[i];
      found->moves[i] = true;
      found->motions_W[i] = {scale / data.size[i] * motions[i].tail<3>(),
                             scale * motions[i].head<3>()};
    }
    groups_.push_back(groups[root]);
  }
}

}  // namespace hvas::statics
