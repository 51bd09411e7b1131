#pragma once

#include <Message_ProgressIndicator.hxx>

#include "cad/import.h"

class TDocStd_Document;

namespace opencascade {
template <class T>
class handle;
}

/** What all readers of OpenCASCADE have in common: its globals, documents and progress. */
namespace hvas::cad {

/** Prepares OpenCASCADE's readers of STEP and IGES once: millimetres, and no messages on standard
 output. Not thread-safe. */
void InitialiseOpenCascade();

/** Passes the progress of a transfer on, as stage "transfer". */
class TransferProgress : public Message_ProgressIndicator {
 public:
  /** @param progress  Outlives the object. */
  explicit TransferProgress(const ProgressFn* progress) : progress_(progress) {}

 private:
  void Show(const Message_ProgressScope& scope, Standard_Boolean is_forced) override;

  const ProgressFn* progress_;
  double shown_{0};
};

/** A new, empty XCAF document. */
[[nodiscard]] opencascade::handle<TDocStd_Document> MakeDocument();

/** Forgets a document; the application of OpenCASCADE would keep it for ever. */
void CloseDocument(const opencascade::handle<TDocStd_Document>& document);

}  // namespace hvas::cad
