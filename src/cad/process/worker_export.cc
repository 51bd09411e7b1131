#include "cad/process/worker_export.h"

#include <exception>
#include <span>
#include <sstream>

#include <APIHeaderSection_MakeHeader.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDocStd_Document.hxx>
#include <fmt/format.h>

#include "base/regular_file.h"
#include "cad/brep/iges_document.h"
#include "cad/brep/step_document.h"
#include "cad/iges/iges_text.h"
#include "cad/import_arguments.h"
#include "cad/limits.h"
#include "cad/process/move_components.h"
#include "cad/process/worker_io.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

int Refuse(const std::string& reason) {
  return HandOver(std::as_bytes(std::span(reason)));
}

/** @returns what went wrong; empty when all is written. */
std::string Write(const opencascade::handle<TDocStd_Document>& document, const std::string& name) {
  STEPCAFControl_Writer writer;
  writer.SetColorMode(Standard_True);
  writer.SetNameMode(Standard_True);
  writer.SetLayerMode(Standard_True);
  writer.SetPropsMode(Standard_True);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  SendStage("translate", 0.5);
  if (!writer.Transfer(document, STEPControl_AsIs)) {
    return "OpenCASCADE cannot translate it";
  }
  // No date: the same product gives the same file.
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  header.SetName(new TCollection_HAsciiString(name.c_str()));
  header.SetTimeStamp(new TCollection_HAsciiString("1970-01-01T00:00:00"));
  header.SetOriginatingSystem(new TCollection_HAsciiString("HVAS"));
  SendStage("write", 0.8);
  if (writer.Write(fmt::format("/proc/self/fd/{}", kOutputDescriptor).c_str()) !=
      IFSelect_RetDone) {
    return "OpenCASCADE cannot write it";
  }
  return "";
}

Result<CadDocument> ReadDocument(const std::filesystem::path& file, const ImportOptions& options) {
  Diagnostics ignored;                 // Reading it for the product has told them.
  constexpr std::size_t kHead = 4096;  // [bytes] in which a format's mark is looked for.
  const ReadWatch watch{SendStage, {}, nullptr};
  if (IsIgesFile(file, ReadFileHead(file, kHead).value_or(std::string()))) {
    return ReadIgesDocument(file, options, watch, &ignored);
  }
  StepText text(ReadStepFile(file, options, &ignored));
  OverrideLengthUnit(options, &text);
  return ReadStepDocument(file, text, options, watch, &ignored);
}

/** Moves parts as a file says: a line each, with a motion and a path.
 @returns what went wrong; empty when all are where they should be. */
std::string Move(const opencascade::handle<TDocStd_Document>& document, const std::string& name,
                 const std::string& file) {
  std::istringstream stream(ReadRegularFile(file).value_or(std::string()));
  Motions motions;
  std::string path;
  for (double w = 0, x = 0, y = 0, z = 0, p_x = 0, p_y = 0, p_z = 0;
       stream >> w >> x >> y >> z >> p_x >> p_y >> p_z && stream.get() == ' ' &&
       std::getline(stream, path);) {
    motions[path] = {Quat(w, x, y, z), Vec3(p_x, p_y, p_z)};
  }
  if (!stream.eof() || motions.empty()) {
    return "the poses cannot be passed to hvas-cad";
  }
  const std::size_t found = MoveComponents(document, name, motions);
  return found == motions.size() ? ""
                                 : fmt::format("{} of {} parts to be moved are not in the file",
                                               motions.size() - found, motions.size());
}

}  // namespace

int WorkerExportStep(const std::vector<std::string>& arguments) {
  const bool has_motions = arguments.size() > 2 && arguments[1] == "--motions";
  const std::size_t first_option = has_motions ? 3 : 1;
  auto options =
      arguments.empty() ? std::nullopt : ParseArguments(std::span(arguments).subspan(first_option));
  if (!options) {
    return kWorkerUsage;
  }
  options->max_parts = kLargestMaxParts;  // Reading it for the product has checked.
  const std::filesystem::path file = arguments.front();
  std::string problem;
  try {
    const auto document = ReadDocument(file, *options);
    problem = !document     ? document.error().message
              : has_motions ? Move(document->document, file.stem().string(), arguments[2])
                            : "";
    if (problem.empty()) {
      problem = Write(document->document, file.filename().string());
    }
  } catch (const Standard_Failure& failure) {
    problem = fmt::format("OpenCASCADE failed: {}", failure.GetMessageString());
  } catch (const std::exception& exception) {
    problem = fmt::format("it cannot be written: {}", exception.what());
  }
  return problem.empty() ? 0 : Refuse(problem);
}

}  // namespace hvas::cad
