// Products of forms that nobody drew against everything that follows the import: welding, mates,
// side file, model, ticks, exports, and with --plan the order, its instructions and taking apart.
// Each product is worked at in a process of its own; what kills or stops that process, an
// exception, an index that leads nowhere and a number that is not finite are findings, which are
// made as simple as possible.
//
//   product_storm [COUNT] [--seed N] [--plan] [--minutes M]
//
// COUNT products (500), of the seeds N, N + 1 and so on (1): a finding is repeated by `1 --seed`
// and its own. It ends earlier after M minutes. Exit status 1 when there are findings.
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <rapidcheck/Random.h>
#include <rapidcheck/Shrinkable.h>

#include "assembly/assembly_setup.h"
#include "assembly/open_product.h"
#include "assembly/plan_order.h"
#include "assembly/prepare_model.h"
#include "assembly/run_disassembly.h"
#include "assembly/stepped_run.h"
#include "base/clock.h"
#include "base/test/temporary_folder.h"
#include "cad/glb.h"
#include "exchange/exported_product.h"
#include "exchange/mjcf.h"
#include "exchange/urdf.h"
#include "exchange/usda.h"
#include "fuzz/random_product.h"
#include "product/product_io.h"
#include "product/validate.h"
#include "shopfloor/dfa_rating.h"
#include "shopfloor/instruction_page.h"
#include "shopfloor/work_animation.h"

namespace {

namespace fs = std::filesystem;
using hvas::fuzz::RandomProduct;
using hvas::product::Product;

constexpr int kGood = 0;
constexpr int kFinding = 3;  // Not 1 or 2, which a sanitizer may exit with.
#ifdef __SANITIZE_ADDRESS__
constexpr rlim_t kSlower = 20;  // Under the sanitizers.
#else
constexpr rlim_t kSlower = 1;
#endif
constexpr rlim_t kSeconds = 10 * kSlower;      // Of CPU, after which a case counts as hanging.
constexpr rlim_t kPlanSeconds = 60 * kSlower;  // With a plan.
// Of CPU, after which the preparation is stopped, as a user stops it: the time of the order grows
// with what lies in one another, and is no finding. What does not end then is one. A choice.
constexpr double kPatience = 0.7 * kSlower;
constexpr rlim_t kMemory = rlim_t{4} << 30;
constexpr int kMostShrinks = 300;                // Attempts to make a finding simpler: a choice.
constexpr double kMostShrinking = 30 * kSlower;  // Of CPU for these attempts [s]: a choice.

/** How far the work on a product has come, in memory that the child shares. */
struct Progress {
  std::array<char, 64> step{};
  std::array<char, 2048> message{};
  bool is_opened{false};
  bool has_mates{false};
  bool is_prepared{false};
  bool is_stopped{false};  ///< The preparation took longer than kPatience.
  bool is_held{false};
};

template <std::size_t kSize>
void Copy(std::string_view text, std::array<char, kSize>* to) {
  const std::size_t count = std::min(text.size(), kSize - 1);
  std::memcpy(to->data(), text.data(), count);
  (*to)[count] = '\0';
}

/** What is wrong with a product or with what came of it. */
class Finding : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void Demand(bool condition, const std::string& what) {
  if (!condition) {
    throw Finding(what);
  }
}

/** Errors are answers, if they say something. */
void CheckError(const hvas::Error& error) {
  Demand(error.code != hvas::ErrorCode::kInternal, "an internal error: " + error.message);
  Demand(!error.message.empty() && !error.where.empty(),
         "an error that says nothing: " + error.message);
}

bool IsFinite(const hvas::spatial::Box& box) {
  return box.is_empty() || (box.low.allFinite() && box.high.allFinite());
}

void CheckProduct(const Product& product) {
  Demand(hvas::product::Validate(product), "the product is not valid");
  std::set<std::string> paths;
  for (const auto& part : product.parts) {
    Demand(part.box_B.low.allFinite() && part.box_B.high.allFinite(), "a part's box is not finite");
    Demand(std::isfinite(part.mass.mass) && part.mass.p_BoBcm_B.allFinite() &&
               part.mass.I_BBcm_B.allFinite() && part.mass.mass >= 0,
           "a part's mass is not finite or below zero");
    for (const auto& feature : part.features) {
      Demand(feature.origin_B.allFinite() && feature.axis_B.allFinite() &&
                 std::isfinite(feature.radius) && std::isfinite(feature.span_low) &&
                 std::isfinite(feature.span_high) && std::isfinite(feature.thread_pitch),
             "a feature is not finite");
    }
    for (const auto& form : part.forms) {
      Demand(form.origin_B.allFinite() && form.axis_B.allFinite() && std::isfinite(form.diameter) &&
                 std::isfinite(form.depth) && std::isfinite(form.lead_in),
             "a form is not finite");
    }
  }
  for (const auto& occurrence : product.occurrences) {
    Demand(hvas::spatial::IsFinite(occurrence.X_WB), "a pose is not finite");
    Demand(paths.insert(occurrence.path).second, "two occurrences have one path");
  }
  for (const auto& mate : product.mates) {
    Demand(hvas::spatial::IsFinite(mate.a.X_BM) && hvas::spatial::IsFinite(mate.b.X_BM) &&
               std::isfinite(mate.hole_low) && std::isfinite(mate.hole_high) &&
               std::isfinite(mate.shaft_low) && std::isfinite(mate.shaft_high) &&
               std::isfinite(mate.overlap) && std::isfinite(mate.confidence),
           "a mate is not finite");
  }
  Demand(IsFinite(product.box_W), "the product's box is not finite");
}

/** Text has no control characters that XML and JSON do not have, and no numbers that are none. */
void CheckText(std::string_view what, const std::string& text) {
  Demand(!text.empty(), fmt::format("{} is empty", what));
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    Demand(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t' || c == '\r',
           fmt::format("{} has the control character {}", what, static_cast<int>(c)));
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      continue;
    }
    const std::string_view word(text.data() + begin, i - begin);
    Demand(word != "nan" && word != "inf", fmt::format("{} has the number {}", what, word));
    begin = i + 1;
  }
}

struct StormOptions {
  long count{500};
  std::uint64_t seed{1};
  bool plans{false};
  double minutes{std::numeric_limits<double>::infinity()};
};

/** The work on one product, in the child. */
class Work {
 public:
  Work(const RandomProduct& random, const StormOptions& options, const fs::path& folder,
       Progress* progress)
      : random_(random), options_(options), file_(folder / "storm.stl"), progress_(*progress) {}

  void Run() {
    Begin("build");
    const Product built = hvas::fuzz::Build(random_);
    CheckProduct(built);
    hvas::fuzz::WriteSideFile(random_, built, file_);
    Begin("open");
    auto opened = hvas::assembly::OpenImported(built, MakeOpenOptions(), &diagnostics_);
    if (!opened) {
      CheckError(opened.error());
      return;
    }
    progress_.is_opened = true;
    progress_.has_mates = !opened->mates.empty();
    CheckProduct(*opened);
    Export(*opened);
    Begin("prepare");
    const auto model = Prepare(*std::move(opened), MakePrepareOptions(built));
    if (!model) {
      CheckError(model.error());
      progress_.is_stopped = model.error().code == hvas::ErrorCode::kCancelled;
      return;
    }
    progress_.is_prepared = true;
    CheckModel(**model);
    Begin("run");
    RunTicks(*model);
    Begin("stepped run");
    LeadParts(*model);
    if (options_.plans) {
      Plan(*model);
    }
  }

 private:
  void Begin(std::string_view step) { Copy(step, &progress_.step); }

  [[nodiscard]] bool Has(int bit) const { return (random_.options >> bit & 1) != 0; }

  [[nodiscard]] hvas::assembly::OpenOptions MakeOpenOptions() const {
    hvas::assembly::OpenOptions open;
    open.file = file_;
    if (Has(2)) {
      open.rigid = {"all"};
    }
    if (Has(3)) {
      open.fits = {"all=H7/p6"};
    }
    return open;
  }

  [[nodiscard]] hvas::assembly::PrepareOptions MakePrepareOptions(const Product& built) const {
    hvas::assembly::PrepareOptions prepare;
    if (Has(0) && !built.occurrences.empty()) {
      prepare.base = built.occurrences.back().path;
    }
    if (Has(1) && !built.occurrences.empty()) {
      prepare.first_parts = {built.occurrences.back().path};
    }
    prepare.seed = Has(4) ? 2 : 1;
    return prepare;
  }

  /** Without a plan, no search for ways that turn: it takes seconds for each part that is stuck. */
  hvas::Result<std::shared_ptr<const hvas::simulation::Model>> Prepare(
      Product product, const hvas::assembly::PrepareOptions& options) {
    std::stop_source stop;
    const std::jthread patience([&stop](const std::stop_token& is_done) {
      const std::clock_t begin = std::clock();
      while (!is_done.stop_requested() && !stop.stop_requested()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (static_cast<double>(std::clock() - begin) > kPatience * CLOCKS_PER_SEC) {
          stop.request_stop();
        }
      }
    });
    hvas::assembly::PrepareOptions stopped = options;
    stopped.stop = stop.get_token();
    if (options_.plans) {
      return hvas::assembly::PrepareModel(std::move(product), stopped, &diagnostics_);
    }
    hvas::simulation::CompileOptions compile = hvas::assembly::MakeCompileOptions(stopped);
    compile.way_looks = 0;
    compile.threads = 1;
    return hvas::simulation::Compile(std::make_shared<Product>(std::move(product)), compile,
                                     &diagnostics_);
  }

  void Export(const Product& product) {
    Begin("serialise");
    const auto bytes = hvas::product::SerialiseProduct(product);
    const auto again = hvas::product::DeserialiseProduct(bytes);
    Demand(again.has_value(), "a product that was written cannot be read");
    Demand(hvas::product::SerialiseProduct(*again) == bytes,
           "a product is not read as it was written");
    Begin("glb");
    for (const bool is_fine : {false, true}) {
      if (const auto glb = hvas::cad::MakeGlb(product, is_fine); !glb) {
        CheckError(glb.error());
      }
    }
    if (product.occurrences.empty()) {
      return;  // No reader gives such a product.
    }
    Begin("bodies for export");
    const auto exported = hvas::exchange::MakeExported(product);
    Begin("mjcf");
    CheckText("mjcf", hvas::exchange::MakeMjcf(exported));
    Begin("urdf");
    for (const auto& [name, text] : hvas::exchange::MakeUrdf(exported, "storm")) {
      if (fs::path(name).extension() == ".urdf") {
        CheckText("urdf", text);
      }
    }
    Begin("usda");
    CheckText("usda", hvas::exchange::MakeUsda(exported));
  }

  static void CheckModel(const hvas::simulation::Model& model) {
    for (const auto& body : model.bodies) {
      Demand(hvas::spatial::IsFinite(body.X_WB_goal) && hvas::spatial::IsFinite(body.X_WB_start),
             "a body's pose is not finite");
      Demand(body.mass.mass > 0 && std::isfinite(body.mass.mass), "a body has no mass");
    }
    for (const auto& step : model.sequence.steps) {
      Demand(step.extraction_W.allFinite() && std::abs(step.extraction_W.norm() - 1) < 1e-6,
             "a way out has no direction");
      Demand(std::isfinite(step.engage_distance) && step.offset_W.allFinite(),
             "a step is not finite");
    }
    Demand(std::isfinite(model.table_z) && model.centre_W.allFinite() &&
               std::isfinite(model.transfer_radius),
           "the table is not finite");
  }

  /** Ten ticks of an assembly by a simulated person, and ten more, a second later. */
  static void RunTicks(const std::shared_ptr<const hvas::simulation::Model>& model) {
    hvas::assembly::AssemblySetup setup(
        model, hvas::assembly::MakePersonHand(*model, hvas::assembly::MakePersonTick({}), {}, 1),
        nullptr);
    hvas::simulation::RunLockstep(setup.MakeExecution(0.01));
    for (const auto& state : setup.simulation().physics().parts()) {
      Demand(hvas::spatial::IsFinite(state.X_WB), "a part's pose is not finite");
    }
  }

  /** Ten ticks with each part in the hand, half way out of its place. */
  void LeadParts(const std::shared_ptr<const hvas::simulation::Model>& model) {
    const auto& steps = model->sequence.steps;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].kind != hvas::sequence::SequenceStep::Kind::kInsert) {
        continue;
      }
      hvas::assembly::SteppedOptions options;
      options.step = i;
      const hvas::spatial::Pose& X_WB = model->bodies[steps[i].occurrence.index()].X_WB_goal;
      const double out = 0.5 * steps[i].engage_distance;
      options.X_WB_start = hvas::spatial::Pose(X_WB.q(), X_WB.p() + out * steps[i].extraction_W);
      options.contact_in_holes = Has(5);
      options.threads_turn = Has(5);
      auto run = hvas::assembly::SteppedRun::Create(model, options);
      if (!run) {
        CheckError(run.error());
        continue;
      }
      progress_.is_held = true;
      hvas::simulation::HandReference reference;
      reference.X_WR = hvas::spatial::Pose((*run)->goal()) * (*run)->X_HB().Inverse();
      reference.is_gripping = true;
      for (const auto& row : (*run)->Step(reference, 10)) {
        for (const double value : row.X_WB) {
          Demand(std::isfinite(value), "the pose of a held part is not finite");
        }
        for (const double value : row.F_felt_W) {
          Demand(std::isfinite(value), "a felt force is not finite");
        }
        for (const double value : row.F_true_W) {
          Demand(std::isfinite(value), "a true force is not finite");
        }
      }
    }
  }

  void Plan(const std::shared_ptr<const hvas::simulation::Model>& model) {
    Begin("plan");
    hvas::assembly::PlanOptions plan_options;
    plan_options.time = std::chrono::seconds(2);
    const auto plan = hvas::assembly::PlanOrder(*model, plan_options);
    if (!plan) {
      CheckError(plan.error());
      return;
    }
    Begin("work plan");
    const auto work = hvas::shopfloor::MakeWorkPlan(*model, *plan);
    Begin("instructions");
    if (const auto page = hvas::shopfloor::MakeInstructionPage(*model, work, {})) {
      CheckText("instructions", *page);
    } else {
      CheckError(page.error());
    }
    Begin("animation");
    if (const auto animation = hvas::shopfloor::MakeWorkAnimation(*model, work); !animation) {
      CheckError(animation.error());
    }
    Begin("design for assembly");
    if (const auto rating = hvas::shopfloor::RateAssembly(*model, *plan); !rating) {
      CheckError(rating.error());
    } else {
      Demand(std::isfinite(rating->sheet.seconds), "the time of a worksheet is not finite");
    }
    Begin("disassembly");
    if (const auto apart = hvas::assembly::PlanDisassembly(*model, "", {}); !apart) {
      CheckError(apart.error());
    }
  }

  const RandomProduct& random_;
  const StormOptions& options_;
  fs::path file_;
  Progress& progress_;
  hvas::Diagnostics diagnostics_;
};

[[noreturn]] void WorkAndExit(const RandomProduct& random, const StormOptions& options,
                              const fs::path& folder, Progress* progress) {
  const rlim_t seconds = options.plans ? kPlanSeconds : kSeconds;
  const rlimit time{seconds, seconds + 1};
  setrlimit(RLIMIT_CPU, &time);
  if (kSlower == 1) {  // The sanitizers need all addresses.
    const rlimit memory{kMemory, kMemory};
    setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const int log = open((folder / "stderr").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(log, STDERR_FILENO);
  try {
    Work(random, options, folder, progress).Run();
  } catch (const Finding& finding) {
    Copy(finding.what(), &progress->message);
    _exit(kFinding);
  } catch (const std::exception& exception) {
    Copy(std::string("an exception escapes: ") + exception.what(), &progress->message);
    _exit(kFinding);
  }
  _exit(kGood);
}

/** What came of a product. */
struct Outcome {
  bool is_good{true};
  Progress progress;
  std::string what;  ///< Empty where it is good.
  double cpu_s{0};
};

class Storm {
 public:
  explicit Storm(const StormOptions& options)
      : options_(options),
        progress_(static_cast<Progress*>(mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE,
                                              MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    if (progress_ == MAP_FAILED) {
      throw std::runtime_error("no shared memory");
    }
  }

  /** @returns the number of findings. */
  int Run() {
    const auto generate = hvas::fuzz::GenerateProduct();
    const std::int64_t begin_ns = hvas::MonotonicNs();
    const auto is_over = [&] {
      return 1e-9 * static_cast<double>(hvas::MonotonicNs() - begin_ns) > 60 * options_.minutes;
    };
    long i = 0;
    for (; i < options_.count && !is_over(); ++i) {
      const std::uint64_t seed = options_.seed + static_cast<std::uint64_t>(i);
      const auto product = generate(rc::Random(seed));
      const Outcome outcome = Try(product.value());
      opened_ += outcome.progress.is_opened ? 1 : 0;
      mated_ += outcome.progress.has_mates ? 1 : 0;
      prepared_ += outcome.progress.is_prepared ? 1 : 0;
      stopped_ += outcome.progress.is_stopped ? 1 : 0;
      held_ += outcome.progress.is_held ? 1 : 0;
      if (outcome.cpu_s > longest_s_) {
        longest_s_ = outcome.cpu_s;
        longest_seed_ = seed;
      }
      if (!outcome.is_good) {
        Report(seed, product, outcome);
      }
    }
    fmt::print(
        "{} products of seed {}: {} opened, {} with mates, {} prepared ({} stopped), {} with a "
        "part in the hand; longest "
        "{:.1f} s of CPU (seed {}); {} findings\n",
        i, options_.seed, opened_, mated_, prepared_, stopped_, held_, longest_s_, longest_seed_,
        findings_.size());
    for (const auto& [what, seeds] : findings_) {
      fmt::print("  {} times, first seed {}: {}\n", seeds.size(), seeds.front(), what);
    }
    return static_cast<int>(findings_.size());
  }

 private:
  Outcome Try(const RandomProduct& random) {
    *progress_ = {};
    rusage before{};
    getrusage(RUSAGE_CHILDREN, &before);
    const pid_t child = fork();
    if (child == 0) {
      WorkAndExit(random, options_, folder_.path(), progress_);
    }
    int status = 0;
    waitpid(child, &status, 0);
    rusage after{};
    getrusage(RUSAGE_CHILDREN, &after);
    Outcome outcome;
    outcome.progress = *progress_;
    outcome.cpu_s = ToSeconds(after) - ToSeconds(before);
    outcome.is_good = WIFEXITED(status) && WEXITSTATUS(status) == kGood;
    if (!outcome.is_good) {
      const std::string step = progress_->step.data();
      outcome.what = WIFSIGNALED(status) ? fmt::format("{}: {}", step, NameOf(WTERMSIG(status)))
                     : WEXITSTATUS(status) == kFinding
                         ? fmt::format("{}: {}", step, progress_->message.data())
                         : fmt::format("{}: exit status {}", step, WEXITSTATUS(status));
    }
    return outcome;
  }

  static double ToSeconds(const rusage& usage) {
    const auto sum = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return sum(usage.ru_utime) + sum(usage.ru_stime);
  }

  static std::string NameOf(int number) {
    return number == SIGXCPU || number == SIGKILL ? "hangs"
                                                  : fmt::format("ends by {}", strsignal(number));
  }

  /** What a child said last, without the numbers that differ from case to case. */
  [[nodiscard]] std::string ReadLog() const {
    std::ifstream stream(folder_ / "stderr");
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    constexpr std::size_t kMost = 4000;
    return text.size() > kMost ? text.substr(0, kMost) : text;
  }

  void Report(std::uint64_t seed, const rc::Shrinkable<RandomProduct>& product,
              const Outcome& first) {
    auto& seeds = findings_[first.what];
    seeds.push_back(seed);
    if (seeds.size() > 1) {
      return;  // Known already.
    }
    fmt::print("seed {}: {}\n{}", seed, first.what, hvas::fuzz::Describe(product.value()));
    std::fflush(stdout);
    rc::Shrinkable<RandomProduct> best = product;
    int tries = 0;
    double cpu_s = 0;
    const auto may_go_on = [&] { return tries < kMostShrinks && cpu_s < kMostShrinking; };
    for (bool is_simpler = true; is_simpler && may_go_on();) {
      is_simpler = false;
      auto shrinks = best.shrinks();
      for (auto next = shrinks.next(); next && may_go_on(); next = shrinks.next()) {
        ++tries;
        const Outcome outcome = Try(next->value());
        cpu_s += outcome.cpu_s;
        if (outcome.what == first.what) {
          best = *next;
          is_simpler = true;
          break;
        }
      }
    }
    Try(best.value());
    fmt::print("made simpler:\n{}{}\n", hvas::fuzz::Describe(best.value()), ReadLog());
    std::fflush(stdout);
  }

  const StormOptions options_;
  const hvas::testing::TemporaryFolder folder_;
  Progress* progress_;
  std::map<std::string, std::vector<std::uint64_t>> findings_;
  long opened_{0}, mated_{0}, prepared_{0}, stopped_{0}, held_{0};
  double longest_s_{0};
  std::uint64_t longest_seed_{0};
};

}  // namespace

int main(int argc, char** argv) {
  StormOptions options;
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--plan") {
      options.plans = true;
    } else if (words[i] == "--seed" && i + 1 < words.size()) {
      options.seed = std::strtoull(words[++i].c_str(), nullptr, 10);
    } else if (words[i] == "--minutes" && i + 1 < words.size()) {
      options.minutes = std::strtod(words[++i].c_str(), nullptr);
    } else if (const long count = std::strtol(words[i].c_str(), nullptr, 10); count > 0) {
      options.count = count;
    } else {
      fmt::print(
          stderr,
          "usage: {} [COUNT] [--seed N] [--plan] [--minutes M]   COUNT products, 500 by default\n",
          argv[0]);
      return 1;
    }
  }
  try {
    return Storm(options).Run() == 0 ? 0 : 1;
  } catch (const std::exception& exception) {
    fmt::print(stderr, "{}\n", exception.what());
    return 1;
  }
}
