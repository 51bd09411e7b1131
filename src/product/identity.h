#pragma once

#include <string>
#include <vector>

/** What the management data of a CAD file say of a product besides its shape (X2, layers Z, B and
 L). Texts are valid UTF-8, as in the file, and empty where it states nothing. */
namespace hvas::product {

/** A product, subassembly or part as one item of a company's data: STEP's PRODUCT with its
 PRODUCT_DEFINITION_FORMATION, or IGES's part number. */
struct Identity {
  std::string id;                   ///< Number of the item.
  std::string description;          ///< Description of the item.
  std::string version;              ///< Revision of the item.
  std::string version_description;  ///< Description of the revision.
  std::string designer;             ///< Persons who made it, joined by ", ".
  std::string organisation;         ///< Their organisations, joined by ", ".
  std::string created;              ///< Date of the making, as 2024-05-31T12:30:00.

  [[nodiscard]] bool is_empty() const {
    return id.empty() && description.empty() && version.empty() && version_description.empty() &&
           designer.empty() && organisation.empty() && created.empty();
  }
};

/** The header of an exchange file: FILE_DESCRIPTION, FILE_NAME and FILE_SCHEMA of ISO 10303-21
 (section 8), or the global section of IGES 5.3. */
struct FileHeader {
  std::string format;  ///< "STEP" or "IGES"; empty for formats without such a header.
  std::string name;    ///< The name that the file was written under.
  std::string description;
  std::string time_stamp;          ///< Date of the writing, as in the file.
  std::string authors;             ///< Persons, joined by ", ".
  std::string organisations;       ///< Organisations, joined by ", ".
  std::string preprocessor;        ///< The translator that wrote the file.
  std::string originating_system;  ///< The CAD system.
  std::string authorisation;       ///< Who released it.
  std::string schema;              ///< Schemas, joined by ", "; IGES: the version.
};

}  // namespace hvas::product
