#include "app/studio.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/rendering_options.h"
#include "app/end_watch.h"
#include "app/output/report_failure.h"
#include "app/product/load_product.h"
#include "app/shipped_files.h"
#include "app/study/study_protocol.h"
#include "assembly/prepare_model.h"
#include "base/loop_clock.h"
#include "base/scratch_folder.h"
#include "base/user_folder.h"
#include "cad/input_file.h"
#include "studio/certificate.h"
#include "studio/recent_files.h"
#include "studio/saved_work.h"
#include "studio/server.h"
#include "studio/session_pace.h"
#include "studio/state_folder.h"
#include "studio/study_desk.h"
#include "studio/workbench.h"

namespace hvas::app {
namespace {

struct StudioOptions {
  LoadOptions load;
  std::uint16_t port{0};
  std::string listen;                ///< Empty: this machine only.
  std::vector<std::string> hosts;    ///< Further names of this machine.
  studio::TlsFiles tls;              ///< Empty: a certificate of our own.
  std::filesystem::path recordings;  ///< Empty: the user's own.
  std::vector<std::string> devices;  ///< Addresses that the page can choose from besides.
  std::uint64_t seed{1};             ///< Any number: the actual sizes of the fits follow from it.
  double rate_hz{1000};              ///< X4 asks for 1 kHz.
  haptics::PaperGuidance guidance;
  bool opens_browser{true};
  bool has_workshop{false};      ///< The shipped tools and fixtures are on the table.
  bool is_fresh{false};          ///< Nothing of the work before is gone on with.
  bool new_links{false};         ///< Nor its links.
  std::string clock{"machine"};  ///< "machine", or "steps" for a steered one.
  std::string study;             ///< A protocol; empty: none.
  std::string participant;       ///< "P01"
  std::filesystem::path folder;  ///< Of the study; empty: the protocol's id.
};

std::vector<studio::Example> FindExamples() {
  std::vector<studio::Example> examples{
      {"gear_pump", "Gear pump", "38 parts: press fits, dowels, screws", "gear_pump.step"},
      {"bushing", "Bushing", "3 parts: a bushing pressed into a plate, and a shaft in the bushing",
       "bushing.step"},
      {"frame_500", "Frame", "500 parts, to test large products", "frame_500.step"}};
  const std::filesystem::path folder = FindProductsFolder();
  std::erase_if(examples, [&](studio::Example& example) {
    example.file = folder / example.file;
    return !std::filesystem::exists(example.file);
  });
  return examples;
}

/** The examples, and the files that were opened last. */
std::vector<studio::Example> FindOffered(const std::filesystem::path& recent) {
  std::vector<studio::Example> offered = FindExamples();
  for (const std::filesystem::path& file : studio::LoadRecentFiles(recent)) {
    offered.push_back({fmt::format("recent-{}", offered.size()), file.filename().string(),
                       file.parent_path().string(), file, true});
  }
  return offered;
}

/** Adds the tools and fixtures that are shipped. */
void AddShippedAccessories(LoadOptions* load) {
  const std::filesystem::path folder = FindProductsFolder() / "tools";
  for (const char* name :
       {"hex_key_4", "hex_key_5", "hammer", "screwdriver", "spanner", "caliper"}) {
    load->tools.push_back((folder / (std::string(name) + ".step")).string());
  }
  for (const char* name : {"vise", "chuck", "tray", "vblock"}) {
    load->bench.push_back((folder / (std::string(name) + ".step")).string());
  }
}

studio::WorkbenchOptions MakeWorkbench(const StudioOptions& options) {
  studio::WorkbenchOptions bench;
  bench.recordings_folder = options.recordings;
  if (const auto data = FindUserFolder("XDG_DATA_HOME", ".local/share");
      data && options.recordings.empty()) {
    bench.recordings_folder = *data / "recordings";
  }
  bench.scenes.seed = options.seed;
  constexpr std::uint32_t kBelowRecordings = 0x3FFFFFFF;  // which begin above it, in the page
  // Scenes of a second, so that a program that starts a second later begins beyond them.
  constexpr std::uint32_t kScenesPerSecond = 64;  // Edits are fewer: a choice.
  bench.scenes.last_epoch =
      (kScenesPerSecond * static_cast<std::uint32_t>(std::time(nullptr))) & kBelowRecordings;
  bench.rate_hz = options.rate_hz;
  bench.devices = options.devices;
  bench.guidance = options.guidance;
  bench.scenes.shape_cache = assembly::MakeShapeCache(CacheDirectory(options.load));
  LoadOptions load = options.load;
  if (options.has_workshop) {
    AddShippedAccessories(&load);
  }
  bench.scenes.load = [load](const std::filesystem::path& file, const cad::ProgressFn& progress,
                             std::stop_token stop, Diagnostics* diagnostics) {
    LoadOptions one = load;
    one.file = file;
    one.progress = progress;
    one.stop = std::move(stop);
    return LoadProduct(one, diagnostics);
  };
  return bench;
}

/** Opens the page with whatever the desktop opens pages with; says nothing where there is none. */
void OpenBrowser(const std::string& link) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) {
    return;
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::execlp("xdg-open", "xdg-open", link.c_str(), static_cast<char*>(nullptr));
    ::_exit(1);
  }
}

std::filesystem::path FullPath(const std::filesystem::path& file) {
  std::error_code failed;
  return std::filesystem::weakly_canonical(file, failed);
}

/** What an earlier start has kept of the same: a product, a session of a study, or no file at all.
 @param scratch  Where nothing can be kept. */
Result<studio::StateFolder> TakeFolder(const StudioOptions& options,
                                       const std::filesystem::path& scratch) {
  std::string subject = options.load.file.empty() ? "" : FullPath(options.load.file).string();
  if (!options.study.empty()) {
    subject = fmt::format("study {} {} {}", options.study, FullPath(options.folder).string(),
                          options.participant);
  }
  if (const auto state = FindUserFolder("XDG_STATE_HOME", ".local/state")) {
    auto folder = studio::StateFolder::Take(*state / "studio", subject);
    if (folder) {
      return folder;
    }
    fmt::print(stderr, "warning: this session cannot be saved for the next start: {}\n",
               folder.error().ToString());
  }
  return studio::StateFolder::Take(scratch, subject);
}

/** The work to go on with; none where another product is asked for than it was of. */
std::optional<studio::SavedWork> FindWork(const StudioOptions& options,
                                          const studio::StateFolder& folder) {
  if (!options.study.empty()) {
    return std::nullopt;  // it has a journal of its own
  }
  auto work = studio::LoadWork(folder.work_file());
  const bool is_same =
      work && (options.load.file.empty() || FullPath(work->file) == FullPath(options.load.file));
  if (!work && work.error().code != ErrorCode::kNotFound) {
    fmt::print(stderr, "warning: the saved work cannot be restored: {}\n", work.error().ToString());
  }
  if (!is_same || options.is_fresh) {
    studio::BackUpWork(folder.work_file());
    return std::nullopt;
  }
  return std::move(*work);
}

/** Addresses by which others could reach this machine. */
std::vector<std::string> ListReachable() {
  auto names = studio::ListNamesOf("0.0.0.0").value_or(std::vector<std::string>());
  std::erase_if(names, [](const std::string& name) {
    return name.find_first_not_of("0123456789.") != std::string::npos;
  });
  return names;
}

/** Everything that a server for other machines needs besides. @returns what to print of its
 certificate. */
Result<std::string> PrepareForOthers(const StudioOptions& options, studio::ServerOptions* served) {
  auto names = studio::ListNamesOf(options.listen);
  if (!names) {
    return Unexpected(names.error());
  }
  names->insert(names->end(), options.hosts.begin(), options.hosts.end());
  served->address = options.listen;
  served->names = std::move(*names);
  if (!options.tls.certificate.empty()) {
    served->tls = options.tls;
    const auto fingerprint = studio::CalcFingerprint(options.tls.certificate);
    return fingerprint ? Result<std::string>(fmt::format("Certificate: SHA-256 {}\n", *fingerprint))
                       : Unexpected(fingerprint.error());
  }
  const auto folder = studio::FindCertificateFolder();
  if (!folder) {
    return Unexpected(folder.error());
  }
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto own = studio::EnsureCertificate(
      *folder, served->names, std::chrono::duration_cast<std::chrono::seconds>(now).count());
  if (!own) {
    return Unexpected(own.error());
  }
  served->tls = own->files;
  return fmt::format(
      "Browsers will warn about the self-signed certificate{}. Continue only if its fingerprint "
      "is\n"
      "  SHA-256 {}\n",
      own->is_new ? ", a new one" : "", own->fingerprint);
}

void PrintLinks(const studio::Server& server, const studio::ServerOptions& served) {
  const std::vector<std::string> hosts =
      served.tls ? served.names : std::vector<std::string>{"127.0.0.1"};
  for (const std::string& host : hosts) {
    fmt::print("{} {}\n", &host == hosts.data() ? "The studio is at" : "              or",
               server.LinkFor(studio::Role::kOperator, host));
  }
  if (served.desk != nullptr) {
    fmt::print("The link above is for the experimenter. Link for the participant: {}\n",
               server.LinkFor(studio::Role::kParticipant, hosts.front()));
  }
  fmt::print("Link for viewers: {}\n", server.LinkFor(studio::Role::kViewer, hosts.front()));
}

/** The session of a study, or nothing where none is asked for. */
Result<std::unique_ptr<studio::StudyDesk>> OpenDesk(const StudioOptions& options,
                                                    studio::Workbench* workbench) {
  if (options.study.empty()) {
    return nullptr;
  }
  const auto protocol = FindProtocol(options.study);
  if (!protocol) {
    return Unexpected(protocol.error());
  }
  studio::StudyDesk::Options desk;
  desk.participant = options.participant;
  const auto product = FindProductOf(*protocol);
  if (!product) {
    return Unexpected(product.error());
  }
  desk.product = *product;
  desk.unix_ms = [] {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::int64_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
  };
  auto folder = study::StudyFolder::Create(
      options.folder.empty() ? std::filesystem::path(protocol->id) : options.folder, *protocol,
      options.seed);
  if (!folder) {
    return Unexpected(folder.error());
  }
  return studio::StudyDesk::Open(std::move(*folder), workbench, std::move(desk));
}

/** Says what was kept of the work before, and how the program is ended. */
void PrintWelcome(const studio::Server& server, const std::optional<studio::SavedWork>& work,
                  const std::string& about_certificate) {
  if (server.has_kept_links()) {
    fmt::print("The links of the previous start are still valid, and open pages reconnect.\n");
  }
  if (work) {
    fmt::print("The work on {} is restored; use --fresh to start over.\n", work->name);
  }
  fmt::print("{}Press Ctrl+C to end it.\n", about_certificate);
  std::fflush(stdout);
}

/** Opens what the user works on: what was saved, or else the file that is named. */
void OpenWork(const StudioOptions& options, const std::optional<studio::SavedWork>& work,
              const std::filesystem::path& recent, studio::Workbench* workbench) {
  if (work) {
    workbench->opener().Resume(*work);
  } else if (!options.load.file.empty()) {
    workbench->opener().Open(options.load.file, options.load.file.filename().string());
  }
  if (!options.load.file.empty()) {
    studio::NoteRecentFile(recent, FullPath(options.load.file));
  }
}

/** The file that remembers which products were opened last. */
std::filesystem::path FindRecentFile(const std::filesystem::path& scratch) {
  const auto state = FindUserFolder("XDG_STATE_HOME", ".local/state");
  return (state ? *state : scratch) / "studio" / "recent.json";
}

/** Starts the server, and serves until the program is to end.
 @param steps  The clock of the session, which goes on by steps of its work; null: the machine's. */
Result<void> Serve(const StudioOptions& options, const studio::StateFolder& folder,
                   const std::optional<studio::SavedWork>& work,
                   const std::filesystem::path& recent, SteeredClock* steps, EndWatch* end,
                   studio::Workbench* workbench) {
  studio::ServerOptions served;
  served.port = options.port;
  served.upload_folder = folder.uploads();
  served.access_file = folder.access_file();
  served.audit_file = folder.audit_file();
  served.reachable = ListReachable();
  std::string about_certificate;
  if (!options.listen.empty()) {
    auto prepared = PrepareForOthers(options, &served);
    if (!prepared) {
      return Unexpected(prepared.error());
    }
    about_certificate = std::move(*prepared);
  }
  const auto desk = OpenDesk(options, workbench);
  if (!desk) {
    return Unexpected(desk.error());
  }
  served.desk = desk->get();
  studio::Server server(workbench, FindOffered(recent), served);
  if (auto started = server.Start(); !started) {
    return started;
  }
  PrintLinks(server, served);
  if (*desk != nullptr) {
    (*desk)->Start();
  }
  PrintWelcome(server, work, about_certificate);
  std::optional<ClockDriver> driver;
  if (steps != nullptr) {
    driver.emplace(steps, studio::SessionPace(&workbench->live()));
  }
  OpenWork(options, work, recent, workbench);
  if (options.opens_browser) {
    OpenBrowser(
        server.LinkFor(studio::Role::kOperator, served.tls ? served.names.front() : "127.0.0.1"));
  }
  end->Wait();
  fmt::print("\n");
  std::fflush(stdout);
  workbench->live().SetForcesOff(true);  // whatever else takes its time
  workbench->Stop();
  server.Stop();
  return {};
}

int RunStudio(const StudioOptions& options) {
  if (!options.load.file.empty()) {
    if (const auto input = cad::CheckInput(options.load.file); !input) {
      return ReportFailure(input.error());
    }
  }
  EndWatch end;
  std::signal(SIGPIPE, SIG_IGN);
  const auto scratch = ScratchFolder::Make();
  const auto folder = scratch ? TakeFolder(options, scratch->path())
                              : Result<studio::StateFolder>(Unexpected(scratch.error()));
  if (!folder) {
    return ReportFailure(folder.error());
  }
  if (options.new_links) {
    std::error_code ignored;
    std::filesystem::remove(folder->access_file(), ignored);
  }
  const auto work = FindWork(options, *folder);
  folder->RemoveUploadsBut(work ? work->file : "");
  studio::WorkbenchOptions bench = MakeWorkbench(options);
  std::optional<SteeredClock> steps;
  if (options.clock == "steps") {
    bench.clock = &steps.emplace();
  }
  bench.work_file = options.study.empty() ? folder->work_file() : std::filesystem::path();
  studio::Workbench workbench(bench);
  const auto served = Serve(options, *folder, work, FindRecentFile(scratch->path()),
                            steps ? &*steps : nullptr, &end, &workbench);
  return served ? 0 : ReportFailure(served.error());
}

constexpr const char* kStudioFooter =
    "The printed links contain a secret. The first browser that opens the first link gets "
    "control;\n"
    "the second link is for viewers. The next start for the same product has the same links and\n"
    "restores the work, however the program has ended. Without --listen, only programs on this\n"
    "machine can reach the studio. With --listen, connections are encrypted: compare the "
    "printed\n"
    "fingerprint with the one that the browser shows.\n"
    "A headset on a cable needs no --listen: run `adb reverse tcp:8080 tcp:8080`, and open the\n"
    "link in its browser with localhost instead of 127.0.0.1.\n"
    "Examples:\n"
    "  hvas studio\n"
    "  hvas studio products/gear_pump.step\n"
    "  hvas studio products/nut_bolt.step --threads-turn\n"
    "  hvas studio --study fit-2016 --participant P01 -o fits\n"
    "  hvas studio pump.step --port 8080 --no-open\n"
    "  hvas studio pump.step --device plugin:./my_device.so\n"
    "  hvas studio pump.step --listen 192.168.1.5 --port 8443\n"
    "  hvas studio pump.step --listen 0.0.0.0 --host workshop.local\n"
    "  hvas studio --listen 0.0.0.0 --host studio.example --certificate full.pem --key key.pem";

/** Where the studio listens, and what it is known by there. */
void AddAddressOptions(CLI::App* command, StudioOptions* options) {
  command->add_option("--port", options->port, "Port to listen on; default: any free port")
      ->check(CLI::Range(1, 65535));
  CLI::Option* listen = command->add_option("--listen", options->listen,
                                            "Address of this machine to listen on for headsets and "
                                            "other machines, or 0.0.0.0 for all; uses TLS");
  command->add_option("--host", options->hosts, "Additional host name of this machine")
      ->needs(listen);
  CLI::Option* certificate =
      command
          ->add_option("--certificate", options->tls.certificate,
                       "Certificate in PEM format, instead of a generated one")
          ->needs(listen);
  CLI::Option* key =
      command
          ->add_option("--key", options->tls.key, "Private key of the certificate, in PEM format")
          ->needs(certificate);
  certificate->needs(key);
}

void AddStudyOptions(CLI::App* command, StudioOptions* options) {
  CLI::Option* study = command->add_option(
      "--study", options->study,
      "Run a study with a participant: a protocol file, or xia-2011 or fit-2016");
  CLI::Option* participant = command
                                 ->add_option("--participant", options->participant,
                                              "Id of the participant: P01, P02, ...")
                                 ->needs(study);
  study->needs(participant);
  command
      ->add_option("-o,--output", options->folder,
                   "Folder of the study; default: the protocol's id")
      ->needs(study);
}

}  // namespace

void AddStudio(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "studio", "Assemble a product by hand in a browser, with a mouse, headset or haptic device");
  const auto options = std::make_shared<StudioOptions>();
  command->add_option("file", options->load.file,
                      "STEP, IGES or mesh file, or a folder of meshes, to open");
  AddAddressOptions(command, options.get());
  command->add_flag("!--no-open", options->opens_browser, "Do not open a browser");
  command->add_flag("--fresh", options->is_fresh,
                    "Start with all parts on the table instead of restoring the saved work");
  command->add_flag("--new-links", options->new_links,
                    "Make new links, and revoke those of the previous start");
  command->add_option("--recordings", options->recordings,
                      "Folder for recordings; default ~/.local/share/hvas/recordings");
  command->add_option("--device", options->devices,
                      "Device that the page offers besides those of this machine, as of "
                      "`hvas assemble --device`; may be given several times");
  AddStudyOptions(command, options.get());
  command->add_option("--seed", options->seed, "Seed of the parts' actual sizes and of the study")
      ->capture_default_str();
  command->add_option("--rate", options->rate_hz, "Rate of the haptic loop [Hz]")
      ->check(CLI::Range(1000.0, 8000.0))
      ->capture_default_str();
  command
      ->add_option(
          "--clock", options->clock,
          "Clock of the session: machine, or steps. By steps, time waits for the loops and "
          "for the browser that holds a part: a busy machine is slow, and nothing is late. "
          "For tests; real devices need the machine's clock")
      ->check(CLI::IsMember({"machine", "steps"}))
      ->capture_default_str();
  AddGuidanceOptions(command, &options->guidance);
  command->add_flag("--workshop", options->has_workshop,
                    "Put the shipped tools and fixtures on the table: hexagon keys, hammer, "
                    "screwdriver, spanner, caliper, vise, chuck, tray and V-block");
  AddAccessoryOptions(command, &options->load);
  AddLoadOptions(command, &options->load, Limited::kOpening);
  command->footer(kStudioFooter);
  command->callback([options, status] { *status = RunStudio(*options); });
}

}  // namespace hvas::app
