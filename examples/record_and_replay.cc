// Assembles a product, keeps the evidence, and runs every tick of it again from the record alone:
//
//   record_and_replay FILE RECORD
#include <cstdio>
#include <utility>

#include <hvas/hvas.h>

namespace {

int Fail(const hvas::Error& error) {
  std::fprintf(stderr, "%s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s FILE RECORD\n", argv[0]);
    return 1;
  }
  hvas::Diagnostics diagnostics;
  hvas::assembly::OpenOptions open;
  open.file = argv[1];
  auto product = hvas::assembly::OpenProduct(open, &diagnostics);
  if (!product) {
    return Fail(product.error());
  }
  const auto model = hvas::assembly::PrepareModel(*std::move(product), {}, &diagnostics);
  if (!model) {
    return Fail(model.error());
  }
  hvas::assembly::RunOptions run;
  run.record = argv[2];
  run.is_record_replaced = true;
  const auto outcome = hvas::assembly::RunAssembly(*model, run);
  if (!outcome) {
    return Fail(outcome.error());
  }

  auto reader = hvas::record::Reader::Open(argv[2]);
  if (!reader) {
    return Fail(reader.error());
  }
  const auto recorded = hvas::session::LoadModel(&*reader, {}, &diagnostics);
  if (!recorded) {
    return Fail(recorded.error());
  }
  const auto report = hvas::session::Replay(&*reader, *recorded, {});
  if (!report) {
    return Fail(report.error());
  }
  std::printf("%lld ticks, %s\n", static_cast<long long>(report->ticks),
              report->is_exact() ? "bit for bit" : "not all as recorded");
  return report->is_exact() ? 0 : 2;
}
