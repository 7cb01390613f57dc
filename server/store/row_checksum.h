#ifndef BCCSKEL_SERVER_STORE_ROW_CHECKSUM_H_
#define BCCSKEL_SERVER_STORE_ROW_CHECKSUM_H_

#include <cstdint>
#include <string>
#include <vector>

#include "server/store/sql_database.h"

namespace bccskel::server {

// What rows are checksummed as. The numbers of the kinds are stored, in a way: they never change.
void AppendChecked(const SqlValue& value, std::string& bytes);

// CRC-32C of the table's name and the row's columns.
int64_t ChecksumOf(const char* table, const std::vector<SqlValue>& values);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_ROW_CHECKSUM_H_
