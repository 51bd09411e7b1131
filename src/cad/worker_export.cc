#include "cad/worker_export.h"

#include <exception>
#include <span>

#include <APIHeaderSection_MakeHeader.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDocStd_Document.hxx>
#include <fmt/format.h>

#include "cad/step_document.h"
#include "cad/worker.h"
#include "cad/worker_io.h"

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
  TellStage("translate", 0.5);
  if (!writer.Transfer(document, STEPControl_AsIs)) {
    return "OpenCASCADE cannot translate it";
  }
  // No date: the same product gives the same file.
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  header.SetName(new TCollection_HAsciiString(name.c_str()));
  header.SetTimeStamp(new TCollection_HAsciiString("1970-01-01T00:00:00"));
  header.SetOriginatingSystem(new TCollection_HAsciiString("HVAS"));
  TellStage("write", 0.8);
  if (writer.Write(fmt::format("/proc/self/fd/{}", kOutputDescriptor).c_str()) !=
      IFSelect_RetDone) {
    return "OpenCASCADE cannot write it";
  }
  return "";
}

}  // namespace

int WorkerExportStep(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1) {
    return kWorkerUsage;
  }
  const std::filesystem::path file = arguments.front();
  std::string problem;
  try {
    Diagnostics ignored;  // Reading it for the product has told them.
    const auto document = ReadStepDocument(file, {TellStage, {}, nullptr}, &ignored);
    problem = document ? Write(*document, file.filename().string()) : document.error().message;
  } catch (const Standard_Failure& failure) {
    problem = fmt::format("OpenCASCADE gave up: {}", failure.GetMessageString());
  } catch (const std::exception& exception) {
    problem = fmt::format("it cannot be written: {}", exception.what());
  }
  return problem.empty() ? 0 : Refuse(problem);
}

}  // namespace hvas::cad
