#pragma once

/** @file
 HVAS for programs that build on it, in one header: opening, preparing, planning and assembling a
 product, a hand of one's own, records and their replay. docs/cpp.md is the tutorial. */

#include "api/version.h"
#include "assembly/assembly_setup.h"
#include "assembly/explain_gaps.h"
#include "assembly/hand.h"
#include "assembly/open_product.h"
#include "assembly/plan_order.h"
#include "assembly/prepare_model.h"
#include "assembly/run_assembly.h"
#include "assembly/run_disassembly.h"
#include "assembly/stepped_run.h"
#include "base/error_name.h"
#include "exchange/mjcf.h"
#include "exchange/urdf.h"
#include "exchange/usda.h"
#include "fits/insertion.h"
#include "fits/iso286.h"
#include "fits/population.h"
#include "fits/press_fit.h"
#include "product/names.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "session/replay.h"
