#include "session/recorded_model.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/digest.h"
#include "base/parse_json.h"
#include "product/accessories.h"
#include "product/product_io.h"
#include "sequence/extraction.h"
#include "session/command_json.h"
#include "session/deformable_json.h"

namespace hvas::session {
namespace {

constexpr const char* kSeed = "seed";
constexpr const char* kPairs = "pairs";
constexpr const char* kSteps = "steps";
constexpr const char* kFingerprint = "fingerprint";
constexpr const char* kFlexible = "flexible";             // Pairs of occurrence and allowance [m].
constexpr const char* kDrawingErrors = "drawing_errors";  // Two occurrences, two faces, and sizes.
constexpr const char* kElastic = "elastic";  // Occurrence, kind and sizes in SI, in a fixed order.

/** Of what the ticks see of a model: equal models have equal ones. */
std::string CalcFingerprint(const simulation::Model& model) {
  Digest digest;
  const auto add_pose = [&digest](const spatial::Pose& X) {
    digest.AddBytes(std::as_bytes(std::span(X.p().data(), 3)));
    digest.AddBytes(std::as_bytes(std::span(X.q().coeffs().data(), 4)));
  };
  for (const simulation::Body& body : model.bodies) {
    add_pose(body.X_WB_start);
    add_pose(body.X_WB_goal);
    digest.AddDouble(body.mass.mass);
    digest.AddText(model.product->part_of(body.occurrence).shape_hash);
    digest.AddDouble(body.shape->voxel());
  }
  for (const sequence::DrawnOverlap& overlap : model.sequence.overlaps) {
    digest.AddInt(overlap.a.value());
    digest.AddInt(overlap.b.value());
    digest.AddDouble(overlap.allowed);
  }
  for (const sequence::GivingPair& give : model.sequence.gives) {
    digest.AddInt(give.flexible.value());
    digest.AddInt(give.other.value());
    digest.AddDouble(give.depth);
    digest.AddDouble(give.curve ? haptics::CalcGivingPeak(*give.curve).in : 0.0);
  }
  for (const simulation::PressedPair& press : model.presses) {
    digest.AddInt(press.moved.value());
    digest.AddDouble(press.compression);
    digest.AddDouble(press.force);
  }
  for (const sequence::FaceRelief& relief : model.sequence.reliefs) {
    digest.AddInt(relief.occurrence.value());
    digest.AddInt(relief.face);
    digest.AddDouble(relief.depth);
  }
  digest.AddDouble(model.table_z);
  return digest.Hex();
}

Json MakeFlexibleJson(const product::Product& product) {
  Json list = Json::array();
  for (const product::FlexiblePart& part : product.flexible) {
    list.push_back({part.occurrence.value(), part.allowance, static_cast<int>(part.kind)});
  }
  return list;
}

/** Takes the flexible parts of a record into its product; false where they are none. Older records
 have no list. */
bool ReadFlexible(const Json& json, product::Product* product) {
  if (!json.contains(kFlexible)) {
    return true;
  }
  const Json& list = json[kFlexible];
  for (const Json& entry : list) {
    const bool is_entry =
        entry.is_array() && entry.size() == 3 && entry[0].is_number_unsigned() &&
        entry[0].get<std::uint64_t>() < product->occurrences.size() && entry[1].is_number() &&
        entry[2].is_number_unsigned() &&
        entry[2].get<std::uint64_t>() <= static_cast<std::uint64_t>(product::kLastFlexibleKind);
    if (!is_entry) {
      return false;
    }
    product->flexible.push_back({product::OccurrenceId(entry[0].get<std::uint32_t>()),
                                 static_cast<product::FlexibleKind>(entry[2].get<int>()),
                                 entry[1].get<double>(), "the record"});
  }
  return list.is_array();
}

/** The sizes of a part that pushes back, in the order of the record. */
template <typename Part>
auto SizesOf(Part& part) {
  return std::array{&part.axis_B.x(),   &part.axis_B.y(),   &part.axis_B.z(), &part.centre_B.x(),
                    &part.centre_B.y(), &part.centre_B.z(), &part.length,     &part.outer,
                    &part.inner,        &part.thickness,    &part.coils,      &part.area,
                    &part.free_area,    &part.free_size,    &part.modulus,    &part.poisson_ratio,
                    &part.stiffness,    &part.lip_at,       &part.lip_root,   &part.lip_radius};
}

Json MakeElasticJson(const product::Product& product) {
  Json list = Json::array();
  for (const product::ElasticPart& part : product.elastic) {
    Json entry{part.occurrence.value(), static_cast<int>(part.kind)};
    for (const double* size : SizesOf(part)) {
      entry.push_back(*size);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

// Sizes that records have had since parts that push back are in them; lips came later.
constexpr std::size_t kFirstSizes = 17;

/** Takes the parts that push back of a record into its product; false where they are none. Records
 of products without any, and older ones, have no list. */
bool ReadElastic(const Json& json, product::Product* product) {
  if (!json.contains(kElastic)) {
    return true;
  }
  const Json& list = json[kElastic];
  for (const Json& entry : list) {
    product::ElasticPart part;
    const auto sizes = SizesOf(part);
    const bool is_entry = entry.is_array() && entry.size() >= 2 + kFirstSizes &&
                          entry.size() <= 2 + sizes.size() && entry[0].is_number_unsigned() &&
                          entry[0].get<std::uint64_t>() < product->occurrences.size() &&
                          entry[1].is_number_unsigned() &&
                          entry[1].get<std::uint64_t>() <=
                              static_cast<std::uint64_t>(product::ElasticKind::kLipSeal) &&
                          std::all_of(entry.begin() + 2, entry.end(),
                                      [](const Json& size) { return size.is_number(); });
    if (!is_entry) {
      return false;
    }
    part.occurrence = product::OccurrenceId(entry[0].get<std::uint32_t>());
    part.kind = static_cast<product::ElasticKind>(entry[1].get<int>());
    for (std::size_t i = 0; i + 2 < entry.size(); ++i) {
      *sizes[i] = entry[2 + i].get<double>();
    }
    part.reason = "the record";
    product->elastic.push_back(std::move(part));
  }
  return list.is_array();
}

Json MakeErrorsJson(const product::Product& product) {
  Json list = Json::array();
  for (const product::DrawingError& error : product.drawing_errors) {
    list.push_back({error.a.value(), error.b.value(), error.face_a.value(), error.face_b.value(),
                    error.is_in_hole ? 1 : 0, error.depth, error.largest, error.volume});
  }
  return list;
}

/** Reads the errors of the drawing of a record; none where they are not valid. Records of products
 without any, and older ones, have no list. */
std::optional<std::vector<product::DrawingError>> ReadErrors(const Json& json,
                                                             const product::Product& product) {
  std::vector<product::DrawingError> errors;
  if (!json.contains(kDrawingErrors)) {
    return errors;
  }
  constexpr std::size_t kNumbers = 8;   // Of each error.
  constexpr std::size_t kIntegers = 5;  // They come first.
  const Json& list = json[kDrawingErrors];
  for (const Json& entry : list) {
    const auto is_index = [](const Json& number) { return number.is_number_unsigned(); };
    const bool is_entry = entry.is_array() && entry.size() == kNumbers &&
                          std::all_of(entry.begin(), entry.begin() + kIntegers, is_index) &&
                          std::all_of(entry.begin() + kIntegers, entry.end(),
                                      [](const Json& number) { return number.is_number(); }) &&
                          entry[0].get<std::uint64_t>() < product.occurrences.size() &&
                          entry[1].get<std::uint64_t>() < product.occurrences.size();
    if (!is_entry) {
      return std::nullopt;
    }
    product::DrawingError error;
    error.a = product::OccurrenceId(entry[0].get<std::uint32_t>());
    error.b = product::OccurrenceId(entry[1].get<std::uint32_t>());
    error.face_a = product::FaceId(entry[2].get<std::uint32_t>());
    error.face_b = product::FaceId(entry[3].get<std::uint32_t>());
    const auto has_face = [&product](product::OccurrenceId id, product::FaceId face) {
      return !face.is_valid() || face.index() < product.part_of(id).faces.size();
    };
    if (!has_face(error.a, error.face_a) || !has_face(error.b, error.face_b)) {
      return std::nullopt;
    }
    error.is_in_hole = entry[4].get<int>() != 0;
    error.depth = entry[5].get<double>();
    error.largest = entry[6].get<double>();
    error.volume = entry[7].get<double>();
    errors.push_back(error);
  }
  return list.is_array() ? std::optional(std::move(errors)) : std::nullopt;
}

/** Takes the errors of the drawing of a record into its product; false where they are not valid. */
bool TakeErrors(const Json& json, product::Product* product) {
  auto errors = ReadErrors(json, *product);
  if (errors) {
    product->drawing_errors = *std::move(errors);
  }
  return errors.has_value();
}

std::optional<fits::PairChoice> FindPairChoice(const std::string& name) {
  const auto found = std::find(fits::kPairChoices.begin(), fits::kPairChoices.end(), name);
  return found == fits::kPairChoices.end()
             ? std::nullopt
             : std::optional(static_cast<fits::PairChoice>(found - fits::kPairChoices.begin()));
}

}  // namespace

std::optional<fits::PairChoice> FindPairChoice(const record::Meta& meta) {
  const auto found = meta.find(kPairs);
  return found == meta.end() ? fits::PairChoice::kAny : FindPairChoice(found->second);
}

record::Meta MakeModelMeta(const simulation::Model& model) {
  Json parts = Json::array();
  for (const product::Occurrence& occurrence : model.product->occurrences) {
    parts.push_back({{"id", occurrence.id.value()},
                     {"path", occurrence.path},
                     {"shape_hash", model.product->part_of(occurrence.id).shape_hash}});
  }
  return {{"product", model.product->name},
          {"source", model.product->source},
          {"seed", std::to_string(model.seed)},
          {kPairs, std::string(fits::ToString(model.pairs))},
          {"model_json", parts.dump()}};
}

void AttachModel(const simulation::Model& model, record::Recorder* recorder) {
  recorder->AddAttachment({kProductAttachment, product::SerialiseProduct(*model.product)});
  Json json{{kSeed, model.seed},
            {kPairs, fits::ToString(model.pairs)},
            {kSteps, MakeStepsJson(model.sequence.steps)},
            {kFlexible, MakeFlexibleJson(*model.product)},
            {kFingerprint, CalcFingerprint(model)}};
  if (!model.product->elastic.empty()) {
    json[kElastic] = MakeElasticJson(*model.product);
  }
  if (!model.product->drawing_errors.empty()) {
    json[kDrawingErrors] = MakeErrorsJson(*model.product);
  }
  const std::string text = json.dump();
  const auto bytes = std::as_bytes(std::span(text));
  recorder->AddAttachment({kModelAttachment, {bytes.begin(), bytes.end()}});
  AttachDeformables(model.deformables, recorder);
}

namespace {

/** Reads what AttachModel() attaches at the beginning of each recording, and says why it is not
 there. */
Result<std::vector<std::byte>> ReadOwnAttachment(record::Reader* reader, const char* name) {
  auto bytes = reader->ReadAttachment(name);
  if (bytes || bytes.error().code != ErrorCode::kNotFound) {
    return bytes;
  }
  constexpr int kFirstWithAttachments = 3;  // Layout version of records.
  if (reader->schema() >= kFirstWithAttachments && !reader->is_complete()) {
    return Fail(ErrorCode::kUnreadable,
                "the recording ended before its first second, and its product was not written",
                reader->path().string(), "record the session again");
  }
  return Fail(ErrorCode::kUnsupported,
              reader->schema() < kFirstWithAttachments
                  ? "the record contains no product; it was written by an older version of HVAS"
                  : fmt::format("the record was written without a product: it has no \"{}\"", name),
              reader->path().string(), "record the session again");
}

}  // namespace

Result<product::Product> LoadProduct(record::Reader* reader) {
  const auto bytes = ReadOwnAttachment(reader, kProductAttachment);
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  auto product = product::DeserialiseProduct(*bytes);
  if (!product) {
    return Fail(ErrorCode::kUnsupported,
                "The product in the record was written by another version of HVAS: " +
                    product.error().message + ".",
                reader->path().string(), "Open it with the version of HVAS that wrote it");
  }
  return product;
}

Result<std::optional<product::Product>> FindProduct(record::Reader* reader) {
  if (reader->schema() < 3) {
    return std::nullopt;
  }
  auto product = LoadProduct(reader);
  if (!product) {
    return Unexpected(product.error());
  }
  return std::optional(std::move(*product));
}

namespace {

Json ParseModelJson(const std::vector<std::byte>& bytes) {
  return ParseJson<Json>(
      std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace

Result<std::vector<product::DrawingError>> ListDrawingErrors(record::Reader* reader,
                                                             const product::Product& product) {
  const auto bytes = reader->ReadAttachment(kModelAttachment);
  if (!bytes) {
    return bytes.error().code == ErrorCode::kNotFound
               ? Result<std::vector<product::DrawingError>>({})
               : Unexpected(bytes.error());
  }
  const Json json = ParseModelJson(*bytes);
  auto errors = json.is_object() ? ReadErrors(json, product) : std::nullopt;
  if (!errors) {
    return Fail(ErrorCode::kUnreadable,
                fmt::format("the model in the record has no valid \"{}\"", kDrawingErrors),
                reader->path().string(), "restore the file from a copy");
  }
  return *std::move(errors);
}

Result<std::vector<product::OccurrenceId>> ListPartsWithoutStep(record::Reader* reader,
                                                                const product::Product& product) {
  const auto bytes = reader->ReadAttachment(kModelAttachment);
  if (!bytes) {
    return bytes.error().code == ErrorCode::kNotFound
               ? Result<std::vector<product::OccurrenceId>>({})
               : Unexpected(bytes.error());
  }
  const Json json = ParseModelJson(*bytes);
  JsonFields fields(json);
  const auto steps = ParseSteps(fields.Array(kSteps), product.occurrences.size());
  if (!steps) {
    return Unexpected(steps.error());
  }
  std::vector<bool> has_step(product.occurrences.size(), false);
  for (const sequence::SequenceStep& step : *steps) {
    for (const product::OccurrenceId part : sequence::UnitOf(step)) {
      has_step[part.index()] = true;
    }
  }
  for (const sequence::SequenceStep& step : *steps) {
    if (step.kind == sequence::SequenceStep::Kind::kAssume) {
      has_step[step.occurrence.index()] = false;  // Also where it moves with a subassembly later.
    }
  }
  for (const auto kind : {product::AccessoryKind::kTool, product::AccessoryKind::kFixture,
                          product::AccessoryKind::kBench}) {
    for (const product::OccurrenceId id : product::ListAccessories(product, kind)) {
      has_step[id.index()] = true;
    }
  }
  std::vector<product::OccurrenceId> without;
  for (const product::Occurrence& occurrence : product.occurrences) {
    if (!has_step[occurrence.id.index()]) {
      without.push_back(occurrence.id);
    }
  }
  return without;
}

Result<std::shared_ptr<const simulation::Model>> LoadModel(record::Reader* reader,
                                                           simulation::CompileOptions options,
                                                           Diagnostics* diagnostics) {
  auto product = LoadProduct(reader);
  if (!product) {
    return Unexpected(product.error());
  }
  const auto bytes = ReadOwnAttachment(reader, kModelAttachment);
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  const Json json = ParseModelJson(*bytes);
  JsonFields fields(json);
  std::string fingerprint;
  fields(kFingerprint, fingerprint);
  auto steps = ParseSteps(fields.Array(kSteps), product->occurrences.size());
  if (!steps) {
    return Unexpected(steps.error());
  }
  if (!fields.has(kSeed) || !json[kSeed].is_number_unsigned()) {
    fields.Refuse(kSeed);
  }
  // Older records have no choice: their pairs were drawn from the zones once.
  const auto pairs = !fields.has(kPairs) ? fits::PairChoice::kAny
                     : json[kPairs].is_string()
                         ? FindPairChoice(json[kPairs].get_ref<const std::string&>())
                         : std::nullopt;
  if (!pairs) {
    fields.Refuse(kPairs);
  }
  if (json.is_object() && !ReadFlexible(json, &*product)) {
    fields.Refuse(kFlexible);
  }
  if (json.is_object() && !ReadElastic(json, &*product)) {
    fields.Refuse(kElastic);
  }
  if (json.is_object() && !TakeErrors(json, &*product)) {
    fields.Refuse(kDrawingErrors);
  }
  if (!fields.refused().empty()) {
    return Fail(ErrorCode::kUnreadable,
                "the model in the record has no valid \"" + fields.refused() + "\"",
                reader->path().string(), "restore the file from a copy");
  }
  options.seed = json[kSeed].get<std::uint64_t>();
  options.pairs = pairs.value_or(fits::PairChoice::kAny);
  options.steps = std::move(*steps);
  auto model = simulation::Compile(std::make_shared<product::Product>(std::move(*product)), options,
                                   diagnostics);
  if (model && CalcFingerprint(**model) != fingerprint) {
    diagnostics->Warn("model-differs", reader->path().string(),
                      "this version of HVAS prepares the product differently from the one that "
                      "recorded it, so ticks can differ",
                      "replay it with the version that recorded it");
  }
  return model;
}

}  // namespace hvas::session
