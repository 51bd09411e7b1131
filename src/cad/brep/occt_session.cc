#include "cad/brep/occt_session.h"

#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Message_ProgressScope.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>

namespace hvas::cad {

void InitialiseOpenCascade() {
  static const bool is_done = [] {
    STEPCAFControl_Controller::Init();
    IGESControl_Controller::Init();
    // Its messages go to std::cout; what matters in them comes back as a status.
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    return true;
  }();
  static_cast<void>(is_done);
}

void TransferProgress::Show(const Message_ProgressScope& /*scope*/,
                            const Standard_Boolean /*is_forced*/) {
  const double fraction = GetPosition();
  if (*progress_ && fraction >= shown_ + 0.01) {
    shown_ = fraction;
    (*progress_)("transfer", fraction);
  }
}

Handle(TDocStd_Document) MakeDocument() {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  return document;
}

void CloseDocument(const Handle(TDocStd_Document) & document) {
  XCAFApp_Application::GetApplication()->Close(document);
}

}  // namespace hvas::cad
