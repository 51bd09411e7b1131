// What is made of a record, read back by other means than what wrote it.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "evidence/demonstrations.h"
#include "evidence/picture.h"
#include "evidence/summary.h"
#include "evidence/tables.h"
#include "evidence/test/evidence_fixture.h"

namespace hvas::evidence {
namespace {

using nlohmann::json;
using testing::EvidenceTest;
using testing::NumberAt;
using testing::ReadAll;

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

TEST_F(EvidenceTest, CsvHasEveryNumberExactlyUnderItsName) {
  ASSERT_TRUE(WriteCsv(&reader, {}, out / "x.csv").has_value());
  std::istringstream text(ReadAll(out / "x.csv"));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = Split(line);
  ASSERT_EQ(names.size(), TickColumns().size());
  EXPECT_EQ(names.front(), "time_s");
  std::size_t row = 0;
  for (; std::getline(text, line); ++row) {
    const std::vector<std::string> cells = Split(line);
    ASSERT_EQ(cells.size(), names.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const double value = TickColumns()[k].get(ticks[row]);
      if (std::isfinite(value)) {
        ASSERT_EQ(std::stod(cells[k]), value) << names[k] << " of tick " << row;
      } else {
        ASSERT_EQ(cells[k], "");
      }
    }
  }
  EXPECT_EQ(row, ticks.size());
}

TEST_F(EvidenceTest, JsonIsOfTheSpanAndAsOftenAsAskedFor) {
  ASSERT_TRUE(WriteJson(&reader, {{1'000'000'000, 2'000'000'000}, 10}, out / "x.json").has_value());
  const json document = json::parse(ReadAll(out / "x.json"));
  EXPECT_EQ(document["ticks"].size(), 101u);
  EXPECT_EQ(document["ticks"][1][0], 1.01);
  EXPECT_EQ(document["columns"].size(), document["ticks"][0].size());
  EXPECT_EQ(document["columns"][0]["unit"], "s");
  EXPECT_EQ(document["parts"].size(), 2u);
  EXPECT_EQ(document["meta"]["seed"], "1");
  EXPECT_EQ(document["events"].back()["details"]["reasons"][0], "limited");
}

TEST_F(EvidenceTest, Hdf5HasAColumnForEachNumberWithItsUnit) {
  ASSERT_TRUE(WriteHdf5(&reader, {}, out / "x.h5").has_value());
  const hid_t file = H5Fopen((out / "x.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  for (const Column& column : TickColumns()) {
    const hid_t set = H5Dopen2(file, (std::string("ticks/") + column.name).c_str(), H5P_DEFAULT);
    ASSERT_GE(set, 0) << column.name;
    std::vector<double> values(ticks.size());
    const hid_t space = H5Dget_space(set);
    ASSERT_EQ(H5Sget_simple_extent_npoints(space), static_cast<hssize_t>(ticks.size()));
    ASSERT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      ASSERT_EQ(values[i], column.get(ticks[i])) << column.name << " of tick " << i;
    }
    EXPECT_GT(H5Aexists(set, "unit"), 0);
    H5Sclose(space);
    H5Dclose(set);
  }
  EXPECT_GT(H5Lexists(file, "events/json", H5P_DEFAULT), 0);
  EXPECT_GT(H5Aexists(file, "seed"), 0);
  H5Fclose(file);
}

TEST_F(EvidenceTest, WayAsGlbIsThatOfThePart) {
  ASSERT_TRUE(WritePathGlb(&reader, {}, out / "x.glb").has_value());
  const std::string bytes = ReadAll(out / "x.glb");
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  ASSERT_EQ(NumberAt<std::uint32_t>(bytes, 8), bytes.size());
  const auto json_size = NumberAt<std::uint32_t>(bytes, 12);
  const json document = json::parse(bytes.substr(20, json_size));
  const auto holds = FindHolds(&reader, {}, MakeCentres(session::LoadProduct(&reader).value()));
  ASSERT_EQ(holds->size(), 1u);
  const Hold& hold = holds->front();
  ASSERT_EQ(document["nodes"].size(), 2u);
  EXPECT_EQ(document["nodes"][1]["extras"]["path_m"], hold.path);
  ASSERT_EQ(document["accessors"][0]["count"], hold.points.size());
  const std::size_t start = 20 + json_size + 8;
  EXPECT_EQ(document["buffers"][0]["byteLength"], bytes.size() - start);
  const auto first = NumberAt<float>(bytes, start);
  EXPECT_EQ(first, static_cast<float>(hold.points.front().x()));
  EXPECT_EQ(NumberAt<float>(bytes, bytes.size() - 4), static_cast<float>(hold.points.back().z()));
}

TEST_F(EvidenceTest, HoldIsWhatItsTicksSay) {
  const auto holds = FindHolds(&reader, {}, MakeCentres(session::LoadProduct(&reader).value()));
  ASSERT_EQ(holds->size(), 1u);
  const Hold& hold = holds->front();
  EXPECT_TRUE(hold.is_seated);
  double peak_felt = 0;
  std::int64_t held = 0;
  for (const record::TickRecord& tick : ticks) {
    if (tick.held == hold.occurrence) {
      ++held;
      peak_felt = std::max(peak_felt, tick.F_felt_W.f.norm());
    }
  }
  EXPECT_EQ(hold.peak_felt, peak_felt);
  EXPECT_EQ(hold.end_ns - hold.start_ns, (held - 1) * 1'000'000);
  EXPECT_GT(hold.insertion, 0.019) << "20 mm of the bore";
  EXPECT_GE(hold.collisions, 1);
  double chords = 0;
  for (std::size_t i = 1; i < hold.points.size(); ++i) {
    chords += (hold.points[i] - hold.points[i - 1]).norm();
  }
  EXPECT_LE(chords, hold.path + 1e-12) << "a polygon is no longer than the way it is of";
  EXPECT_GT(chords, 0.9 * hold.path);
}

TEST_F(EvidenceTest, SummaryHasTheWholeSession) {
  const auto summary = Summarise(&reader);
  ASSERT_TRUE(summary.has_value());
  EXPECT_TRUE(summary->is_complete);
  ASSERT_EQ(summary->hands.size(), 1u);
  EXPECT_EQ(summary->hands[0].ticks, static_cast<std::int64_t>(ticks.size()));
  EXPECT_NEAR(summary->hands[0].period, 1e-3, 1e-12);
  EXPECT_LE(summary->hands[0].bins.size(), 2001u);
  double peak = 0;
  double in_bins = 0;
  for (const record::TickRecord& tick : ticks) {
    peak = std::max(peak, tick.F_true_W.f.norm());
  }
  for (const ForceBin& bin : summary->hands[0].bins) {
    in_bins = std::max(in_bins, bin.true_force);
  }
  EXPECT_EQ(in_bins, peak) << "no bin loses a peak";
  ASSERT_FALSE(summary->incidents.empty());
  EXPECT_EQ(summary->incidents.back().t_ns, 1'000'000'000) << "that which was added last";
  ASSERT_TRUE(summary->product.has_value());
  EXPECT_EQ(summary->product->occurrences.size(), 2u);
}

TEST_F(EvidenceTest, SummaryCountsTicksInWhichContactHadNoRoom) {
  record::RecorderOptions options;
  options.path = out / "crowded";
  const auto& model = simulation::testing::PegInBlockModel();
  const auto recorder = record::Recorder::Create(options, session::MakeModelMeta(*model));
  session::SessionRecorder sink(recorder->get(), *model);
  haptics::TickOutput tick;
  for (const auto& [is_truncated, is_crowded] :
       {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
    tick.is_truncated = is_truncated;
    tick.is_crowded = is_crowded;
    (*recorder)->AddTick(session::MakeTickRecord(0, {}, tick, 0));
  }
  ASSERT_TRUE((*recorder)->Finish().has_value());
  auto crowded = record::Reader::Open(options.path);
  const auto summary = Summarise(&*crowded);
  ASSERT_TRUE(summary.has_value());
  ASSERT_EQ(summary->hands.size(), 1u);
  EXPECT_EQ(summary->hands[0].truncated_ticks, 2);
  EXPECT_EQ(summary->hands[0].crowded_ticks, 1);
}

TEST_F(EvidenceTest, FileThatCannotBeWrittenIsNamedAndLeavesNothing) {
  const auto file = out / "missing" / "x.csv";
  for (const auto write : {&WriteCsv, &WriteJson, &WriteHdf5, &WriteMcap, &WritePathGlb}) {
    const auto done = write(&reader, {}, file);
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().where, file.string());
  }
  EXPECT_TRUE(std::filesystem::is_empty(out.path()));
}

/** Rows of an RGBA picture, each behind its filter's byte. */
std::string Unpack(const std::string& png, int width, int height) {
  // Behind the signature (8 bytes) and the header's chunk (25): length, kind, content.
  const auto size = (static_cast<std::size_t>(static_cast<unsigned char>(png[33])) << 24) |
                    (static_cast<std::size_t>(static_cast<unsigned char>(png[34])) << 16) |
                    (static_cast<std::size_t>(static_cast<unsigned char>(png[35])) << 8) |
                    static_cast<unsigned char>(png[36]);
  std::string rows(static_cast<std::size_t>(height) * (4 * static_cast<std::size_t>(width) + 1), 0);
  uLongf length = rows.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &length,
                       reinterpret_cast<const Bytef*>(png.data() + 41), size),
            Z_OK);
  EXPECT_EQ(length, rows.size());
  return rows;
}

TEST_F(EvidenceTest, PictureShowsTheProductBeforeNothing) {
  const auto& product = *simulation::testing::PegInBlockModel()->product;
  constexpr int kWidth = 120;
  constexpr int kHeight = 90;
  const Projection projection(product.box_W, kWidth, kHeight);
  const std::string png = MakePicture(product, projection);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png, MakePicture(product, projection)) << "the same bytes every time";
  const std::string rows = Unpack(png, kWidth, kHeight);
  const auto alpha = [&rows](int x, int y) {
    const int at = y * (4 * kWidth + 1) + 1 + 4 * x + 3;
    return static_cast<unsigned char>(rows[static_cast<std::size_t>(at)]);
  };
  EXPECT_EQ(alpha(0, 0), 0);
  EXPECT_EQ(alpha(kWidth - 1, kHeight - 1), 0);
  EXPECT_EQ(alpha(kWidth / 2, kHeight / 2), 255);
  const std::vector<std::uint8_t> pixels =
      DrawPixels({{&product.parts[0], product.occurrences[0].X_WB, std::nullopt, {}},
                  {&product.parts[1], product.occurrences[1].X_WB, std::nullopt, {}}},
                 projection);
  ASSERT_EQ(pixels.size(), static_cast<std::size_t>(4 * kWidth * kHeight));
  EXPECT_EQ(pixels[3], 0);
  EXPECT_EQ(pixels[4 * (kHeight / 2 * kWidth + kWidth / 2) + 3], 255);
  // What is nearer to the eye, from the front above, is less deep.
  EXPECT_LT(projection.Project(Vec3(0, -1, 0)).z(), projection.Project(Vec3(0, 1, 0)).z());
  EXPECT_LT(projection.Project(Vec3(0, 0, 1)).y(), projection.Project(Vec3(0, 0, 0)).y());
}

/** A record of a tenth of a second in which one hand after the other holds the peg. */
void RecordHands(const std::vector<std::uint8_t>& hands, const std::filesystem::path& path) {
  constexpr int kTicksEach = 10;
  record::RecorderOptions options;
  options.path = path;
  const auto& model = simulation::testing::PegInBlockModel();
  const auto recorder = record::Recorder::Create(options, session::MakeModelMeta(*model));
  const session::SessionRecorder sink(recorder->get(), *model);
  std::int64_t t_ns = 0;
  for (const std::uint8_t holder : hands) {
    for (int i = 0; i < kTicksEach; ++i, t_ns += 1'000'000) {
      for (const std::uint8_t hand : hands) {
        record::TickRecord tick;
        tick.t_ns = t_ns;
        tick.hand = hand;
        tick.held = hand == holder ? 1 : record::kNoOccurrence;
        ASSERT_TRUE((*recorder)->AddTick(tick));
      }
    }
  }
  ASSERT_TRUE((*recorder)->Finish().has_value());
}

TEST_F(EvidenceTest, EachHandOfARecordIsReadByItself) {
  RecordHands({0, 1, 2, 7}, out / "hands");
  ASSERT_FALSE(HasFatalFailure());
  auto recorded = record::Reader::Open(out / "hands");
  ASSERT_TRUE(recorded);
  const auto summary = Summarise(&*recorded);
  ASSERT_TRUE(summary) << summary.error().ToString();
  ASSERT_EQ(summary->hands.size(), 4u);
  for (const HandSummary& hand : summary->hands) {
    EXPECT_EQ(hand.ticks, 40);
  }
  ASSERT_EQ(summary->holds.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(summary->holds[i].hand, (std::array{0, 1, 2, 7}[i]));
  }
  const auto demonstrations = ListDemonstrations(&*recorded, {});
  ASSERT_TRUE(demonstrations);
  EXPECT_EQ(demonstrations->size(), 4u);
  ASSERT_TRUE(WriteMcap(&*recorded, {}, out / "hands.mcap"));
  for (const char* topic : {"/hand0", "/hand1", "/hand2", "/hand7"}) {
    EXPECT_NE(ReadAll(out / "hands.mcap").find(topic), std::string::npos) << topic;
  }
}

TEST_F(EvidenceTest, HandThatNoSimulationHasIsReadAsTheLastOne) {
  RecordHands({0, 200}, out / "damaged");
  ASSERT_FALSE(HasFatalFailure());
  auto recorded = record::Reader::Open(out / "damaged");
  ASSERT_TRUE(recorded);
  const auto summary = Summarise(&*recorded);
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->holds.size(), 2u);
  EXPECT_EQ(summary->holds[1].hand, haptics::kMaxHands - 1);
  EXPECT_TRUE(ListDemonstrations(&*recorded, {}));
}

}  // namespace
}  // namespace hvas::evidence
