#include "exchange/mjcf.h"

#include <cmath>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "exchange/test/exported.h"

namespace hvas::exchange {
namespace {

using ModelPtr = std::unique_ptr<mjModel, void (*)(mjModel*)>;
using DataPtr = std::unique_ptr<mjData, void (*)(mjData*)>;

ModelPtr Load(const std::string& mjcf) {
  mjVFS files;
  mj_defaultVFS(&files);
  EXPECT_EQ(mj_makeEmptyFileVFS(&files, "model.xml", static_cast<int>(mjcf.size())), 0);
  std::memcpy(files.filedata[0], mjcf.data(), mjcf.size());
  std::array<char, 1000> error{};
  ModelPtr model(mj_loadXML("model.xml", &files, error.data(), static_cast<int>(error.size())),
                 mj_deleteModel);
  mj_deleteVFS(&files);
  EXPECT_NE(model, nullptr) << error.data();
  return model;
}

/** Masses, poses and sizes of a model against the product that it was made of. */
void ExpectSame(const ExportedProduct& exported, const mjModel& model) {
  const product::Product& product = *exported.product;
  for (const ExportedBody& body : exported.bodies) {
    const int id = mj_name2id(&model, mjOBJ_BODY, body.name.c_str());
    ASSERT_GE(id, 0) << body.name;
    const product::MassProperties& mass = product.part_of(body.occurrence).mass;
    EXPECT_NEAR(model.body_mass[id], mass.mass, 1e-9 * mass.mass + 1e-12) << body.name;
    const double trace = model.body_inertia[3 * id] + model.body_inertia[3 * id + 1] +
                         model.body_inertia[3 * id + 2];
    EXPECT_NEAR(trace, mass.I_BBcm_B.trace(), 1e-6 * trace) << body.name;
    const Vec3& p_WB = product.occurrences[body.occurrence.index()].X_WB.p();
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(model.body_pos[3 * id + k], p_WB[k], 1e-9) << body.name;
    }
  }
  for (const ExportedMate& mate : exported.mates) {
    for (const char* side : {"_a", "_b"}) {
      EXPECT_GE(mj_name2id(&model, mjOBJ_SITE, (mate.name + side).c_str()), 0) << mate.name;
    }
    EXPECT_GE(mj_name2id(&model, mjOBJ_TEXT, mate.name.c_str()), 0) << mate.name;
    if (!mate.sizes) {
      continue;
    }
    const int id = mj_name2id(&model, mjOBJ_NUMERIC, (mate.name + "_sizes").c_str());
    ASSERT_GE(id, 0) << mate.name;
    ASSERT_EQ(model.numeric_size[id], 4);
    const mjtNum* sizes = model.numeric_data + model.numeric_adr[id];
    EXPECT_NEAR(sizes[0] - sizes[1], mate.sizes->clearance(), 1e-6) << mate.name;
    EXPECT_NEAR(sizes[2], mate.sizes->min_clearance, 1e-6) << mate.name;
    EXPECT_NEAR(sizes[3], mate.sizes->max_clearance, 1e-6) << mate.name;
  }
}

TEST(MjcfTest, TheGearPumpIsReadWithItsMassesPlacesAndClearances) {
  const product::Product product = testing::Open(testing::kProducts / "gear_pump.step");
  const ExportedProduct exported = MakeExported(product);
  const ModelPtr model = Load(MakeMjcf(exported));
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->nbody, static_cast<int>(product.occurrences.size()) + 1);
  ExpectSame(exported, *model);
}

/** A peg that is let fall into its bore from this far beside the axis and above it [m]. */
class FallingPeg {
 public:
  FallingPeg(double clearance_mm, double beside, double above)
      : product_(testing::OpenPeg(clearance_mm)),
        exported_(MakeExported(product_)),
        model_(Load(MakeMjcf(exported_))),
        data_(mj_makeData(model_.get()), mj_deleteData) {
    const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, exported_.bodies[1].name.c_str());
    q_ = data_->qpos + model_->jnt_qposadr[joint];
    q_[0] += beside;
    q_[2] += above;
  }

  void Run(double seconds) {
    while (data_->time < seconds) {
      mj_step(model_.get(), data_.get());
      for (int i = 0; i < data_->ncon; ++i) {
        deepest_ = std::min(deepest_, data_->contact[i].dist);
      }
    }
  }

  /** How far it is from its place [m]. */
  [[nodiscard]] double height() const { return q_[2] - product_.occurrences[1].X_WB.p().z(); }

  [[nodiscard]] double beside() const { return std::hypot(q_[0], q_[1]); }

  /** Forgets the deepest contact so far. */
  void Forget() { deepest_ = 0; }

  [[nodiscard]] double deepest() const { return deepest_; }

  [[nodiscard]] const mjModel& model() const { return *model_; }

  [[nodiscard]] const ExportedProduct& exported() const { return exported_; }

 private:
  product::Product product_;
  ExportedProduct exported_;
  ModelPtr model_;
  DataPtr data_;
  mjtNum* q_{nullptr};
  double deepest_{0};
};

TEST(MjcfTest, APegFallsIntoItsBoreInMuJoCo) {
  constexpr double kClearance_mm = 0.1;
  FallingPeg peg(kClearance_mm, 0, 46e-3);
  ExpectSame(peg.exported(), peg.model());
  peg.Run(2);  // It falls on the bottom at 0.9 m/s, which soft contact takes a millimetre to stop.
  peg.Forget();
  peg.Run(2.5);
  EXPECT_NEAR(peg.height(), 0, 0.1e-3);
  EXPECT_LE(peg.beside(), 0.5e-3 * kClearance_mm + 10e-6);  // Within its play.
  EXPECT_GT(peg.deepest(), -0.1e-3);
}

TEST(MjcfTest, APegBesideItsBoreStaysOutside) {
  FallingPeg peg(0.1, 15e-3, 46e-3);
  peg.Run(0.3);
  EXPECT_GT(peg.height(), 40e-3);
}

TEST(MjcfTest, APegThatIsTooThickStaysOutside) {
  FallingPeg peg(-0.4, 0, 46e-3);
  peg.Run(1);
  EXPECT_GT(peg.height(), 40e-3);
}

}  // namespace
}  // namespace hvas::exchange
