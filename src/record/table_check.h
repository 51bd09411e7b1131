#pragma once

#include <string>

#include "record/database.h"

namespace hvas::record {

/** Checks that a file that is read has the tables and indexes that some statements make, each with
 the same SQL, and no view, trigger, virtual table or other index beside them: such things would
 work instead of what this program asks for.
 @param statements  CREATE TABLE, as the program that writes such files runs them.
 Errors: kUnreadable, with the first thing that differs. */
[[nodiscard]] Result<void> CheckTables(Database* database, const std::string& statements);

/** Checks one table as CheckTables() does, whatever is beside it.
 @param name  Of a table that the statements make. */
[[nodiscard]] Result<void> CheckTable(Database* database, const std::string& statements,
                                      const std::string& name);

}  // namespace hvas::record
