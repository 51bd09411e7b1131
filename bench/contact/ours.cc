#include "contact/scene.h"
#include "method.h"

namespace hvas::bench {
namespace {

class Ours : public Method {
 public:
  Ours(const std::vector<BenchPart>* parts, bool is_scalar)
      : parts_(parts), is_scalar_(is_scalar) {}

  void Load(std::size_t held, const std::vector<PlacedPart>& scene) override {
    held_ = held;
    scene_ = std::make_unique<contact::Scene>();
    if (is_scalar_) {
      scene_->UseScalarKernel();
    }
    for (const PlacedPart& part : scene) {
      scene_->Add((*parts_)[part.part].shape, part.X_WB);
    }
  }

  std::size_t Query(const spatial::Pose& X_WH) override {
    contact::QueryOptions options;  // Those of a tick.
    options.point_budget = contact::kTickPointBudget;
    options.bounds_refinement = true;
    scene_->Query(*(*parts_)[held_].shape, X_WH, options, &work_);
    return work_.contacts().size();
  }

  std::span<const FoundContact> contacts() override {
    found_.clear();
    for (const contact::Contact& c : work_.contacts()) {
      found_.push_back({c.p_WC, c.nhat_W, -c.distance});
    }
    return found_;
  }

  [[nodiscard]] Vec3 PooledForce() override {
    return work_.layer().CalcWrench(1e3, Vec3::Zero()).f;
  }

  [[nodiscard]] Effort effort() const override {
    const contact::QueryStats& stats = work_.stats();
    return {stats.bodies_tested, stats.points_tested, stats.candidates};
  }

 private:
  const std::vector<BenchPart>* parts_;
  bool is_scalar_;
  std::size_t held_{0};
  std::unique_ptr<contact::Scene> scene_;
  contact::QueryWorkspace work_{contact::QueryMemory::kOfMotion};
  std::vector<FoundContact> found_;
};

}  // namespace

std::unique_ptr<Method> MakeOurs(const std::vector<BenchPart>* parts, bool is_scalar) {
  return std::make_unique<Ours>(parts, is_scalar);
}

}  // namespace hvas::bench
