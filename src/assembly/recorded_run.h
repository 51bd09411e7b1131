#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "assembly/assembly_setup.h"
#include "assembly/hand.h"
#include "assembly/run_assembly.h"
#include "base/result.h"
#include "record/recorder.h"
#include "simulation/model.h"

namespace hvas::assembly {

/** Makes the setup of a run with these hands, whose run passes everything on to `sink`. */
using SetupMaker =
    std::function<std::unique_ptr<RunSetup>(std::vector<Hand> hands, simulation::Sink* sink)>;

/** Opens the devices and the record, and runs what `make_setup` makes, in virtual or in real time,
 until it is done, at the limit, or after a stop. RunAssembly and RunDisassembly differ in the setup
 alone. Errors: those of RunAssembly.
 @param further  Meta of the record besides that of every run. */
[[nodiscard]] Result<RunOutcome> RunRecorded(const simulation::Model& model,
                                             const RunOptions& options, const record::Meta& further,
                                             const SetupMaker& make_setup);

}  // namespace hvas::assembly
