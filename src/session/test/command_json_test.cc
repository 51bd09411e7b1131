#include "session/command_json.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/random.h"
#include "session/tick_options_json.h"

namespace hvas::session {
namespace {

using sequence::SequenceStep;
using simulation::GivenCommand;
using simulation::PartState;
using simulation::Placement;

/** Numbers with all of their digits. */
class Numbers {
 public:
  double operator()() { return random_.Uniform(-1, 1) / 3; }

  Vec3 Vector() {
    const double x = (*this)();
    const double y = (*this)();
    return {x, y, (*this)()};
  }

  spatial::Pose Place() {
    const Vec3 v = Vector();
    return {Quat((*this)(), v.x(), v.y(), v.z()).normalized(), Vector()};
  }

 private:
  Random random_{7};
};

void ExpectEqual(const spatial::Pose& a, const spatial::Pose& b) {
  EXPECT_EQ(a.p(), b.p());
  EXPECT_EQ(a.q().coeffs(), b.q().coeffs());
}

std::vector<PartState> MakeParts(Numbers* numbers, std::size_t count) {
  std::vector<PartState> parts;
  for (std::size_t i = 0; i < count; ++i) {
    parts.push_back({static_cast<Placement>(i % 4), numbers->Place()});
  }
  return parts;
}

TEST(ExactJson, BringsEveryNumberBackBitForBit) {
  Numbers numbers;
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> values{0.0, -0.0, 5e-324, 1e308, 0.1, infinity, -infinity};
  for (int i = 0; i < 1000; ++i) {
    values.push_back(std::ldexp(numbers(), i - 500));
  }
  for (const double value : values) {
    const Json json = Json::parse(Json{{"x_m", MakeJson(value)}}.dump());
    double back = 7;
    JsonFields fields(json);
    fields("x_m", back);
    EXPECT_EQ(back, value);
    EXPECT_EQ(std::signbit(back), std::signbit(value));
  }
  double back = 0;
  const Json json{{"x_m", MakeJson(std::nan(""))}};
  JsonFields fields(json);
  fields("x_m", back);
  EXPECT_TRUE(std::isnan(back));
}

TEST(ExactJson, NamesTheFirstFieldThatIsNotWhatItShouldBe) {
  const Json json = Json::parse(R"({"inner": {"a_m": 1, "b_m": "no"}, "p_m": [1, 2]})");
  JsonFields fields(json);
  double a = 0;
  JsonFields inner = fields.Inner("inner");
  inner("a_m", a);
  EXPECT_EQ(a, 1);
  inner("b_m", a);
  EXPECT_EQ(a, 1) << "stays as it was";
  fields.Take(inner);
  Vec3 p = Vec3::Zero();
  fields("p_m", p);
  EXPECT_EQ(fields.refused(), "inner.b_m");
}

/** Options in which hardly a number is the one that it is by default. */
haptics::TickOptions MakeOptions() {
  Numbers numbers;
  haptics::TickOptions options;
  options.condition = haptics::Condition::kConstraint;
  options.force_map = haptics::ForceMapKind::kPaper;
  options.workspace.mapping = {numbers.Place(), numbers(), numbers.Place().q()};
  options.coupling = {numbers(), numbers(), numbers(), numbers()};
  options.guidance.capture.axial_gap = numbers();
  options.guidance.seat_time = numbers();
  options.contact.friction.viscous = numbers();
  options.contact.stop_depth = numbers();
  options.gravity_W = numbers.Vector();
  options.device.id = "touch";
  options.device.name = "Büchse \"x\"";
  options.device.q_UD = numbers.Place().q();
  options.device.delay = numbers();
  options.limits = haptics::MakeSafetyLimits(options.device);
  options.limits->turn_buzz.window = numbers();
  options.controls_passivity = true;
  options.p_HG = numbers.Vector();
  options.dt = 1e-3 * (1.5 + numbers());
  return options;
}

TEST(TickOptionsJson, BringsAllOptionsBack) {
  for (const bool has_limits : {true, false}) {
    haptics::TickOptions options = MakeOptions();
    if (!has_limits) {
      options.limits.reset();
    }
    const Json json = MakeTickOptionsJson(options);
    const auto back = ParseTickOptions(Json::parse(json.dump()));
    ASSERT_TRUE(back.has_value()) << back.error().ToString();
    EXPECT_EQ(MakeTickOptionsJson(*back), json);
    EXPECT_EQ(back->condition, options.condition);
    EXPECT_EQ(back->force_map, options.force_map);
    EXPECT_EQ(back->dt, options.dt);
    EXPECT_EQ(back->device.name, options.device.name);
    EXPECT_EQ(back->p_HG, options.p_HG);
    EXPECT_EQ(back->workspace.box, options.workspace.box) << "infinite";
    ASSERT_EQ(back->limits.has_value(), has_limits);
    if (has_limits) {
      EXPECT_EQ(back->limits->turn_buzz.window, options.limits->turn_buzz.window);
      EXPECT_EQ(back->limits->continuous_force, options.limits->continuous_force);
    }
  }
}

TEST(TickOptionsJson, W8SaysWhereFitsAreNotRenderedAndReadsOlderOnesThatDoNotSay) {  // A3
  haptics::TickOptions options;
  EXPECT_FALSE(MakeTickOptionsJson(options).contains("renders_fits"));
  EXPECT_TRUE(ParseTickOptions(MakeTickOptionsJson(options))->renders_fits);
  options.renders_fits = false;
  EXPECT_FALSE(ParseTickOptions(MakeTickOptionsJson(options))->renders_fits);
}

TEST(TickOptionsJson, RefusesWhatNoTickCanWorkWith) {
  const Json sound = MakeTickOptionsJson({});
  for (const auto& [field, value] : std::initializer_list<std::pair<const char*, Json>>{
           {"/dt_s", 0},
           {"/dt_s", -1e-3},
           {"/dt_s", "nan"},
           {"/dt_s", "inf"},
           {"/dt_s", 1e300},
           {"/max_virtual_mass_kg", "nan"},
           {"/workspace/mapping/X_WD", {0, 0, 0, 0, 0, 0, 0}},
           {"/workspace/mapping/X_WD", {0, 0, "inf", 1, 0, 0, 0}},
           {"/gravity_W_m_per_s2", {0, "nan", 0}}}) {
    Json json = sound;
    ASSERT_TRUE(json.contains(Json::json_pointer(field))) << field;
    json[Json::json_pointer(field)] = value;
    EXPECT_FALSE(ParseTickOptions(json).has_value()) << field << " = " << value;
  }
}

TEST(TickOptionsJson, NamesAFieldThatIsMissing) {
  Json json = MakeTickOptionsJson(MakeOptions());
  json["limits"]["kick"].erase("jerk_m_per_s3");
  const auto options = ParseTickOptions(json);
  ASSERT_FALSE(options.has_value());
  EXPECT_EQ(options.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(options.error().message.find("limits.kick.jerk_m_per_s3"), std::string::npos);
}

TEST(CommandJson, BringsABeginningBack) {
  Numbers numbers;
  const Beginning beginning{{MakeOptions(), {}}, MakeParts(&numbers, 5)};
  const auto back = ParseBeginning(MakeBeginningJson(beginning), 5);
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  ASSERT_EQ(back->hands.size(), 2u);
  EXPECT_EQ(back->hands[0].dt, beginning.hands[0].dt);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(back->parts[i].placement, beginning.parts[i].placement);
    ExpectEqual(back->parts[i].X_WB, beginning.parts[i].X_WB);
  }
  EXPECT_FALSE(ParseBeginning(MakeBeginningJson(beginning), 4).has_value()) << "another model's";
}

TEST(CommandJson, BringsACommandBackFromWhatHasChanged) {
  Numbers numbers;
  const std::vector<PartState> before = MakeParts(&numbers, 100);
  GivenCommand given;
  given.number = 7;
  given.t_ns = 8;
  given.kind = simulation::TickCommand::Kind::kTake;
  given.hand = 1;
  given.step.kind = SequenceStep::Kind::kPark;
  given.step.occurrence = product::OccurrenceId(3);
  given.step.members = {product::OccurrenceId(4), product::OccurrenceId(99)};
  given.step.extraction_W = numbers.Vector();
  given.step.engage_distance = numbers();
  given.step.offset_W = numbers.Vector();
  given.parts = before;
  given.parts[42] = {Placement::kPlaced, numbers.Place()};
  given.parts[17].X_WB = {given.parts[17].X_WB.q(), -0.0 * Vec3::Ones()};
  const record::Command command = MakeCommand(given, before);
  EXPECT_EQ(command.kind, "take");
  EXPECT_EQ(command.number, 7);
  EXPECT_LT(command.json.size(), 1000u) << "of parts only those that changed";
  const auto back = ParseCommand(command, before, 2);
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  EXPECT_EQ(back->number, given.number);
  EXPECT_EQ(back->t_ns, given.t_ns);
  EXPECT_EQ(back->kind, given.kind);
  EXPECT_EQ(back->hand, given.hand);
  EXPECT_EQ(back->step.kind, given.step.kind);
  EXPECT_EQ(back->step.occurrence, given.step.occurrence);
  EXPECT_EQ(back->step.members, given.step.members);
  EXPECT_EQ(back->step.extraction_W, given.step.extraction_W);
  EXPECT_EQ(back->step.engage_distance, given.step.engage_distance);
  EXPECT_EQ(back->step.offset_W, given.step.offset_W);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(back->parts[i].placement, given.parts[i].placement);
    ExpectEqual(back->parts[i].X_WB, given.parts[i].X_WB);
  }
  EXPECT_TRUE(std::signbit(back->parts[17].X_WB.p().x()));
}

TEST(CommandJson, BringsBackAWayThatTurns) {
  Numbers numbers;
  const std::vector<PartState> before = MakeParts(&numbers, 5);
  GivenCommand given;
  given.kind = simulation::TickCommand::Kind::kTake;
  given.step.occurrence = product::OccurrenceId(3);
  given.step.way = {numbers.Place(), numbers.Place(), numbers.Place()};
  given.parts = before;
  const auto back = ParseCommand(MakeCommand(given, before), before, 2);
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  ASSERT_EQ(back->step.way.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    ExpectEqual(back->step.way[i], given.step.way[i]);
  }
  given.step.way.resize(1);
  EXPECT_FALSE(ParseCommand(MakeCommand(given, before), before, 2).has_value())
      << "a way has two poses at least";
}

TEST(CommandJson, X1BringsBackWhatIsTogether) {
  Numbers numbers;
  const std::vector<PartState> before = MakeParts(&numbers, 5);
  GivenCommand given;
  given.kind = simulation::TickCommand::Kind::kTake;
  given.step.occurrence = product::OccurrenceId(3);
  given.can_join = true;
  given.parts = before;
  given.parts[1].leader = product::OccurrenceId(1);
  given.parts[4].leader = product::OccurrenceId(1);
  const auto back = ParseCommand(MakeCommand(given, before), before, 1);
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  EXPECT_TRUE(back->can_join);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(back->parts[i].leader, given.parts[i].leader);
  }
  const auto apart = ParseCommand(MakeCommand(*back, given.parts), given.parts, 1);
  EXPECT_EQ(apart->parts[4].leader, product::OccurrenceId(1)) << "nothing has changed since";
  given.parts[4].leader = product::OccurrenceId(5);
  EXPECT_FALSE(ParseCommand(MakeCommand(given, before), before, 1)) << "there is no such part";
}

TEST(CommandJson, RefusesWhatPointsOutsideTheModel) {
  Numbers numbers;
  const std::vector<PartState> before = MakeParts(&numbers, 3);
  GivenCommand given;
  given.step.occurrence = product::OccurrenceId(2);
  given.parts = before;
  given.parts[1].placement = Placement::kParked;
  const record::Command good = MakeCommand(given, before);
  ASSERT_TRUE(ParseCommand(good, before, 1).has_value());
  const auto damage = [&](const std::string& from, const std::string& to) {
    record::Command bad = good;
    bad.json.replace(bad.json.find(from), from.size(), to);
    const auto parsed = ParseCommand(bad, before, 1);
    return parsed.has_value() ? std::string("taken") : parsed.error().message;
  };
  EXPECT_NE(damage("\"hand\":0", "\"hand\":1").find("hand"), std::string::npos);
  EXPECT_NE(damage("\"occurrence\":2", "\"occurrence\":3").find("occurrence"), std::string::npos);
  EXPECT_NE(damage("\"occurrence\":1", "\"occurrence\":-1").find("occurrence"), std::string::npos);
  EXPECT_NE(damage("parked", "lost").find("placement"), std::string::npos);
  EXPECT_NE(damage("\"members\":[]", "\"members\":[3]").find("members"), std::string::npos);
  EXPECT_NE(damage("{", "[").find("hand"), std::string::npos) << "no JSON at all";
  record::Command other = good;
  other.kind = "throw";
  EXPECT_FALSE(ParseCommand(other, before, 1).has_value());
}

TEST(CommandJson, BringsAnOrderOfAssemblyBack) {
  std::vector<SequenceStep> steps(6);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i].kind = static_cast<SequenceStep::Kind>(i);
    steps[i].occurrence = product::OccurrenceId(i);
  }
  const auto back = ParseSteps(MakeStepsJson(steps), 6);
  ASSERT_TRUE(back.has_value());
  ASSERT_EQ(back->size(), 6u);
  EXPECT_EQ((*back)[2].kind, SequenceStep::Kind::kPark);
  EXPECT_EQ((*back)[4].kind, SequenceStep::Kind::kAside);
  EXPECT_EQ((*back)[5].kind, SequenceStep::Kind::kReturn);
  EXPECT_FALSE(ParseSteps(MakeStepsJson(steps), 2).has_value());
}

}  // namespace
}  // namespace hvas::session
