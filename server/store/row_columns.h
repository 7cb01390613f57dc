#ifndef BCCSKEL_SERVER_STORE_ROW_COLUMNS_H_
#define BCCSKEL_SERVER_STORE_ROW_COLUMNS_H_

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>

#include "server/store/rows.h"
#include "server/store/sqlite_database.h"
#include "server/store/stored_status.h"

// Rows as SQLite has them. Part of sqlite_job_store.cc.

namespace bccskel::server {

constexpr int64_t kNeverMicros = std::numeric_limits<int64_t>::max();

inline int64_t Number(uint64_t value) { return static_cast<int64_t>(value); }
inline int64_t Number(JobState state) { return static_cast<int64_t>(state); }
inline int64_t Micros(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}
inline int64_t Micros(const std::optional<Time>& time) {
  return time.has_value() ? Micros(*time) : 0;
}
// Also of a number that damage has made.
inline Time TimeOf(int64_t micros) {
  constexpr uint64_t kPerMicro = std::chrono::nanoseconds(std::chrono::microseconds(1)).count();
  return Time(Time::duration(Number(static_cast<uint64_t>(micros) * kPerMicro)));
}
inline std::optional<Time> OptionalTime(int64_t micros) {
  return micros == 0 ? std::nullopt : std::optional(TimeOf(micros));
}

// Columns are read in the order in which the SELECTs below name them; braces keep that order.
inline void Read(SqliteQuery& query, UploadRow& row) {
  row = {.tenant = query.Text(),
         .name = query.Text(),
         .declaration = query.Text(),
         .size_bytes = static_cast<uint64_t>(query.Number()),
         .job = query.Text(),
         .volume = query.Text(),
         .used = TimeOf(query.Number())};
}

inline void Read(SqliteQuery& query, VolumeRow& row) {
  row = {.tenant = query.Text(),
         .name = query.Text(),
         .declaration = query.Text(),
         .blob_digest = query.Text(),
         .volume_digest = query.Text(),
         .size_bytes = static_cast<uint64_t>(query.Number()),
         .created = TimeOf(query.Number()),
         .used = TimeOf(query.Number())};
}

inline void Read(SqliteQuery& query, ResultRow& row) {
  row = {.number = query.Number(),
         .tenant = query.Text(),
         .key = query.Text(),
         .file = query.Text(),
         .file_digest = query.Text(),
         .bytes = static_cast<uint64_t>(query.Number()),
         .records = static_cast<uint64_t>(query.Number()),
         .summary = query.Text()};
}

inline void Read(SqliteQuery& query, JobRow& row) {
  row = {.number = query.Number(),
         .tenant = query.Text(),
         .name = query.Text(),
         .request_id = query.Text(),
         .body = query.Text(),
         .upload = query.Text(),
         .options = query.Text(),
         .priority = static_cast<int>(query.Number()),
         .threads = static_cast<int>(query.Number()),
         .trace = query.Text(),
         .created = TimeOf(query.Number()),
         .volume = query.Text(),
         .state = static_cast<JobState>(query.Number()),
         .attempts = static_cast<int>(query.Number()),
         .crashes = static_cast<int>(query.Number()),
         .sequence = static_cast<uint64_t>(query.Number()),
         .owner = query.Text(),
         .error = StatusOfBytes(query.Text()),
         .result = query.Number(),
         .started = OptionalTime(query.Number()),
         .ended = OptionalTime(query.Number())};
}

inline void Read(SqliteQuery& query, EventRow& row) {
  row = {.job = query.Number(),
         .sequence = static_cast<uint64_t>(query.Number()),
         .time = TimeOf(query.Number()),
         .state = static_cast<JobState>(query.Number()),
         .attempt = static_cast<int>(query.Number()),
         .error = StatusOfBytes(query.Text())};
}

inline void Read(SqliteQuery& query, RemovalRow& row) {
  row = {.kind = static_cast<RemovalRow::Kind>(query.Number()),
         .tenant = query.Text(),
         .name = query.Text()};
}

#define BCCSKEL_UPLOAD_COLUMNS "tenant, name, declaration, size_bytes, job, volume, used"
#define BCCSKEL_VOLUME_COLUMNS \
  "tenant, name, declaration, blob_digest, volume_digest, size_bytes, created, used"
#define BCCSKEL_RESULT_COLUMNS "number, tenant, key, file, file_digest, bytes, records, summary"
#define BCCSKEL_JOB_COLUMNS                                                            \
  "number, tenant, name, request_id, body, upload, options, priority, threads, trace," \
  "created, volume, state, attempts, crashes, sequence, owner, error, result, started, ended"
#define BCCSKEL_EVENT_COLUMNS "job, sequence, time, state, attempt, error"
#define BCCSKEL_REMOVAL_COLUMNS "kind, tenant, name"

// What a row of a table should have in its column row_check, and what is read of one: its columns,
// and whether that is so.
#define BCCSKEL_CHECKSUM(table, columns) "checksum('" table "', " columns ")"
#define BCCSKEL_READ(table, columns) columns ", row_check = " BCCSKEL_CHECKSUM(table, columns)
#define BCCSKEL_SELECT(table, columns) "SELECT " BCCSKEL_READ(table, columns) " FROM " table " "
// After a change of the row.
#define BCCSKEL_SEAL(table, columns) \
  "UPDATE " table " SET row_check = " BCCSKEL_CHECKSUM(table, columns) " WHERE "
#define BCCSKEL_SELECT_UPLOAD BCCSKEL_SELECT("uploads", BCCSKEL_UPLOAD_COLUMNS)
#define BCCSKEL_SELECT_VOLUME BCCSKEL_SELECT("volumes", BCCSKEL_VOLUME_COLUMNS)
#define BCCSKEL_SELECT_RESULT BCCSKEL_SELECT("results", BCCSKEL_RESULT_COLUMNS)
#define BCCSKEL_SELECT_JOB BCCSKEL_SELECT("jobs", BCCSKEL_JOB_COLUMNS)
#define BCCSKEL_SELECT_EVENT BCCSKEL_SELECT("events", BCCSKEL_EVENT_COLUMNS)
#define BCCSKEL_SELECT_REMOVAL BCCSKEL_SELECT("removals", BCCSKEL_REMOVAL_COLUMNS)

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_ROW_COLUMNS_H_
