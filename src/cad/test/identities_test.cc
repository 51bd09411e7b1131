// Who made a product, when, and in which version: the management data of STEP files.
#include "cad/step/identities.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "cad/process/read_cad.h"
#include "cad/step/text_encoding.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::FileHeader;
using product::Identity;

constexpr const char* kIdentityEntities = R"(
#1=PRODUCT('HS-0042','housing','cast, machined',(#9));
#2=PRODUCT_DEFINITION_FORMATION('C','bore widened',#1);
#3=PRODUCT_DEFINITION('design','',#2,#8);
#10=PERSON('jd','Doe','Jane',$,$,$);
#11=ORGANIZATION('w','Works','');
#12=PERSON_AND_ORGANIZATION(#10,#11);
#13=PERSON_AND_ORGANIZATION_ROLE('creator');
#14=CC_DESIGN_PERSON_AND_ORGANIZATION_ASSIGNMENT(#12,#13,(#3));
#15=PERSON('mm','Mill','Max',$,$,$);
#16=PERSON_AND_ORGANIZATION(#15,#11);
#17=PERSON_AND_ORGANIZATION_ROLE('approver');
#18=CC_DESIGN_PERSON_AND_ORGANIZATION_ASSIGNMENT(#16,#17,(#2,#1));
#20=CALENDAR_DATE(2024,31,5);
#21=COORDINATED_UNIVERSAL_TIME_OFFSET(1,0,.AHEAD.);
#22=LOCAL_TIME(12,30,7.5,#21);
#23=DATE_AND_TIME(#20,#22);
#24=DATE_TIME_ROLE('creation_date');
#25=CC_DESIGN_DATE_AND_TIME_ASSIGNMENT(#23,#24,(#3));
#30=PRODUCT('','pin','',(#9));
#31=PRODUCT_DEFINITION_FORMATION_WITH_SPECIFIED_SOURCE('','',#30,.MADE.);
#32=PRODUCT_DEFINITION('design','',#31,#8);
)";

TEST(ReadIdentities, X2HasIdVersionDesignerDateAndDescriptions) {
  const StepText text{kIdentityEntities};
  const auto identities = ReadIdentities(text);
  ASSERT_EQ(identities.count(3), 1u);
  const Identity& identity = identities.at(3);
  EXPECT_EQ(identity.id, "HS-0042");
  EXPECT_EQ(identity.description, "cast, machined");
  EXPECT_EQ(identity.version, "C");
  EXPECT_EQ(identity.version_description, "bore widened");
  EXPECT_EQ(identity.designer, "Jane Doe") << "the approver is no designer";
  EXPECT_EQ(identity.organisation, "Works");
  EXPECT_EQ(identity.created, "2024-05-31T12:30:07");
  EXPECT_EQ(identities.count(32), 0u) << "a product that states nothing has no identity";
}

TEST(ReadIdentities, X2TakesAp214AssignmentsAndDatesWithoutATime) {
  std::string text = kIdentityEntities;
  for (const char* name : {"CC_DESIGN_PERSON", "CC_DESIGN_DATE_AND_TIME"}) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name)) {
      text.replace(at, std::string("CC_DESIGN").size(), "APPLIED");
    }
  }
  text.replace(text.find("APPLIED_DATE_AND_TIME_ASSIGNMENT(#23"), 36,
               "APPLIED_DATE_ASSIGNMENT(#20");
  const StepText entities(text);
  const auto identities = ReadIdentities(entities);
  ASSERT_EQ(identities.count(3), 1u);
  EXPECT_EQ(identities.at(3).designer, "Jane Doe");
  EXPECT_EQ(identities.at(3).created, "2024-05-31");
}

TEST(ReadIdentities, DamagedAssignmentsAreLeftOut) {
  for (const char* statement : {"#14=CC_DESIGN_PERSON_AND_ORGANIZATION_ASSIGNMENT(#14,#14,(#3));",
                                "#14=CC_DESIGN_PERSON_AND_ORGANIZATION_ASSIGNMENT(#99,$,(#3,'x'));",
                                "#14=CC_DESIGN_PERSON_AND_ORGANIZATION_ASSIGNMENT();",
                                "#14=CC_DESIGN_DATE_AND_TIME_ASSIGNMENT(#3,#3,#3);"}) {
    const std::string all =
        std::string(
            "#1=PRODUCT('a','b','',());#2=PRODUCT_DEFINITION_FORMATION('1','',#1);"
            "#3=PRODUCT_DEFINITION('','',#2,#2);") +
        statement;
    const StepText text(all);
    const auto identities = ReadIdentities(text);
    ASSERT_EQ(identities.count(3), 1u);
    EXPECT_EQ(identities.at(3).id, "a");
    EXPECT_EQ(identities.at(3).designer, "");
    EXPECT_EQ(identities.at(3).created, "");
  }
}

TEST(ReadStepHeader, X2HasNameDateAuthorsSystemAndSchema) {
  const FileHeader header = ReadStepHeader(
      "ISO-10303-21;HEADER;\nFILE_DESCRIPTION(('a pump','with oil'),'2;1');\n"
      "FILE_NAME('pump.stp','2024-05-31T12:30:00',('J. Doe','M. Mill'),('Works'),\n"
      "  'ST 7','CAD 8','nobody');FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 }'));ENDSEC;DATA;");
  EXPECT_EQ(header.format, "STEP");
  EXPECT_EQ(header.description, "a pump, with oil");
  EXPECT_EQ(header.name, "pump.stp");
  EXPECT_EQ(header.time_stamp, "2024-05-31T12:30:00");
  EXPECT_EQ(header.authors, "J. Doe, M. Mill");
  EXPECT_EQ(header.organisations, "Works");
  EXPECT_EQ(header.preprocessor, "ST 7");
  EXPECT_EQ(header.originating_system, "CAD 8");
  EXPECT_EQ(header.authorisation, "nobody");
  EXPECT_EQ(header.schema, "AUTOMOTIVE_DESIGN { 1 0 10303 }");
}

TEST(DecodeStepText, DecodesTheEscapesOfPart21) {
  EXPECT_EQ(DecodeStepText("\\X2\\041F04400438\\X0\\ 2"), "При 2");
  EXPECT_EQ(DecodeStepText("\\X4\\0001F600\\X0\\"), "\xF0\x9F\x98\x80");
  EXPECT_EQ(DecodeStepText("M\\X\\FCller"), "Müller");
  EXPECT_EQ(DecodeStepText("M\\S\\|ller"), "Müller");
  EXPECT_EQ(DecodeStepText("\\PE\\\\S\\4\\S\\U\\S\\b\\PA\\ \\S\\|"), "Дет ü") << "ISO 8859-5";
  EXPECT_EQ(DecodeStepText("a\\\\b"), "a\\b");
  EXPECT_EQ(DecodeStepText("\\X2\\04"), "\\X2\\04") << "no escape stays as it is";
}

TEST(ReadCad, X2PartsAndSubassembliesCarryTheIdentitiesOfTheirProducts) {
  const TemporaryFolder folder;
  testing::DocumentBuilder builder;
  const TDF_Label plate = builder.AddPart(testing::MakePlate(), "plate");
  const TDF_Label root = builder.AddAssembly("rig");
  builder.AddComponent(root, plate, testing::Translation(0, 0, 0), "plate");
  builder.AddComponent(root, plate, testing::Translation(0, 0, 50), "plate 2");
  builder.Write(folder / "rig.step");
  std::ifstream stream(folder / "rig.step");
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const auto replace = [&text](const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), with);
  };
  replace("PRODUCT('plate','plate',''", "PRODUCT('PL-7','plate','a plate'");
  replace("PRODUCT('rig','rig',''", "PRODUCT('RG-1','rig','the rig'");
  std::ofstream(folder / "ids.step") << text;
  Diagnostics diagnostics;
  const auto product = ReadCad(folder / "ids.step", {}, &diagnostics);
  ASSERT_TRUE(product.has_value());
  EXPECT_EQ(product->parts.at(0).identity.id, "PL-7");
  EXPECT_EQ(product->parts.at(0).identity.description, "a plate");
  EXPECT_EQ(product->subassemblies.at(0).identity.id, "RG-1");
  EXPECT_EQ(product->header.format, "STEP");
  EXPECT_NE(product->header.originating_system.find("Open CASCADE"), std::string::npos);
}

}  // namespace
}  // namespace hvas::cad
