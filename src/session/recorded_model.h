#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "record/reader.h"
#include "record/recorder.h"
#include "simulation/model.h"

namespace hvas::session {

/** Attachments of a record by which its model is made again. */
inline constexpr const char* kProductAttachment = "product";
inline constexpr const char* kModelAttachment = "model.json";

/** What a record's meta says of a model. */
[[nodiscard]] record::Meta MakeModelMeta(const simulation::Model& model);

/** The choice of pairs in a record's meta: that of older records is kAny. None where it is no
 choice. */
[[nodiscard]] std::optional<fits::PairChoice> FindPairChoice(const record::Meta& meta);

/** Puts into a record what LoadModel takes out of it: the product with its mates and fits, the
 seed, the order of assembly, and a fingerprint. */
void AttachModel(const simulation::Model& model, record::Recorder* recorder);

/** Errors: kUnsupported for a record without a product, or with one of another format. */
[[nodiscard]] Result<product::Product> LoadProduct(record::Reader* reader);

/** Does as LoadProduct(); none for a record of before schema 3, which has no product in it. */
[[nodiscard]] Result<std::optional<product::Product>> FindProduct(record::Reader* reader);

/** Reads the errors of the drawing that the recorded product had; none in older records. Errors:
 those of record::Reader::ReadAttachment; kUnreadable where they are not valid.
 @param product  LoadProduct() of the record. */
[[nodiscard]] Result<std::vector<product::DrawingError>> ListDrawingErrors(
    record::Reader* reader, const product::Product& product);

/** Lists the parts that have no step in a record's order of assembly: no way was found for them.
 Empty where the record has no model.
 @param product  The record's. Errors: kUnreadable for a model that is none. */
[[nodiscard]] Result<std::vector<product::OccurrenceId>> ListPartsWithoutStep(
    record::Reader* reader, const product::Product& product);

/** A record's model, compiled anew.
 @param options  How; the seed and the choice of pairs are those of the record.
 Warns where it is not the one that was recorded, as another version of HVAS prepares it.
 Errors: as LoadProduct() and simulation::Compile(). */
[[nodiscard]] Result<std::shared_ptr<const simulation::Model>> LoadModel(
    record::Reader* reader, simulation::CompileOptions options, Diagnostics* diagnostics);

}  // namespace hvas::session
