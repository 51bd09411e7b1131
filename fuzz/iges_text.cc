// IGES text: the check of its lines and sections.
#include "cad/iges/iges_text.h"

#include <string>
#include <string_view>

#include "fuzz/target.h"

namespace hvas::fuzz {

void TestOne(std::string_view bytes) {
  (void)cad::IsIgesFile("fuzz.step", bytes.substr(0, 4096));
  const auto checked = cad::CheckIgesText(bytes, "fuzz.igs");
  Check(checked || (!checked.error().message.empty() && !checked.error().where.empty() &&
                    !checked.error().remedy.empty()));
}

}  // namespace hvas::fuzz
