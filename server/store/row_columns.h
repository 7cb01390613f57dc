#ifndef BCCSKEL_SERVER_STORE_ROW_COLUMNS_H_
#define BCCSKEL_SERVER_STORE_ROW_COLUMNS_H_

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "server/store/row_checksum.h"
#include "server/store/rows.h"
#include "server/store/sql_database.h"
#include "server/store/stored_status.h"

// Rows as tables have them. Part of sql_job_store.cc.

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

// Columns are read in the order in which the columns below are listed; braces keep that order.
inline void Read(SqlRow& from, UploadRow& row) {
  row = {.tenant = from.Text(),
         .name = from.Text(),
         .declaration = from.Text(),
         .size_bytes = static_cast<uint64_t>(from.Number()),
         .job = from.Text(),
         .volume = from.Text(),
         .used = TimeOf(from.Number()),
         .file = from.Text()};
}

inline void Read(SqlRow& from, VolumeRow& row) {
  row = {.tenant = from.Text(),
         .name = from.Text(),
         .declaration = from.Text(),
         .blob_digest = from.Text(),
         .volume_digest = from.Text(),
         .size_bytes = static_cast<uint64_t>(from.Number()),
         .created = TimeOf(from.Number()),
         .used = TimeOf(from.Number())};
}

inline void Read(SqlRow& from, ResultRow& row) {
  row = {.number = from.Number(),
         .tenant = from.Text(),
         .key = from.Text(),
         .file = from.Text(),
         .file_digest = from.Text(),
         .bytes = static_cast<uint64_t>(from.Number()),
         .records = static_cast<uint64_t>(from.Number()),
         .summary = from.Text()};
}

inline void Read(SqlRow& from, JobRow& row) {
  row = {.number = from.Number(),
         .tenant = from.Text(),
         .name = from.Text(),
         .request_id = from.Text(),
         .body = from.Text(),
         .upload = from.Text(),
         .options = from.Text(),
         .priority = static_cast<int>(from.Number()),
         .threads = static_cast<int>(from.Number()),
         .trace = from.Text(),
         .created = TimeOf(from.Number()),
         .volume = from.Text(),
         .state = static_cast<JobState>(from.Number()),
         .attempts = static_cast<int>(from.Number()),
         .crashes = static_cast<int>(from.Number()),
         .sequence = static_cast<uint64_t>(from.Number()),
         .owner = from.Text(),
         .error = StatusOfBytes(from.Text()),
         .result = from.Number(),
         .started = OptionalTime(from.Number()),
         .ended = OptionalTime(from.Number())};
}

inline void Read(SqlRow& from, EventRow& row) {
  row = {.job = from.Number(),
         .sequence = static_cast<uint64_t>(from.Number()),
         .time = TimeOf(from.Number()),
         .state = static_cast<JobState>(from.Number()),
         .attempt = static_cast<int>(from.Number()),
         .error = StatusOfBytes(from.Text())};
}

inline void Read(SqlRow& from, RemovalRow& row) {
  row = {.kind = static_cast<RemovalRow::Kind>(from.Number()),
         .tenant = from.Text(),
         .name = from.Text()};
}

// The same columns, to be stored.
inline std::vector<SqlValue> ValuesOf(const UploadRow& row) {
  return {SqlValue::Text(row.tenant),
          SqlValue::Text(row.name),
          SqlValue::Blob(row.declaration),
          SqlValue::Number(Number(row.size_bytes)),
          SqlValue::Text(row.job),
          SqlValue::Text(row.volume),
          SqlValue::Number(Micros(row.used)),
          SqlValue::Text(row.file)};
}

inline std::vector<SqlValue> ValuesOf(const VolumeRow& row) {
  return {SqlValue::Text(row.tenant),
          SqlValue::Text(row.name),
          SqlValue::Blob(row.declaration),
          SqlValue::Text(row.blob_digest),
          SqlValue::Text(row.volume_digest),
          SqlValue::Number(Number(row.size_bytes)),
          SqlValue::Number(Micros(row.created)),
          SqlValue::Number(Micros(row.used))};
}

inline std::vector<SqlValue> ValuesOf(const ResultRow& row) {
  return {SqlValue::Number(row.number),
          SqlValue::Text(row.tenant),
          SqlValue::Text(row.key),
          SqlValue::Text(row.file),
          SqlValue::Text(row.file_digest),
          SqlValue::Number(Number(row.bytes)),
          SqlValue::Number(Number(row.records)),
          SqlValue::Blob(row.summary)};
}

inline std::vector<SqlValue> ValuesOf(const JobRow& row) {
  return {SqlValue::Number(row.number),
          SqlValue::Text(row.tenant),
          SqlValue::Text(row.name),
          SqlValue::Text(row.request_id),
          SqlValue::Blob(row.body),
          SqlValue::Text(row.upload),
          SqlValue::Blob(row.options),
          SqlValue::Number(row.priority),
          SqlValue::Number(row.threads),
          SqlValue::Text(row.trace),
          SqlValue::Number(Micros(row.created)),
          SqlValue::Text(row.volume),
          SqlValue::Number(Number(row.state)),
          SqlValue::Number(row.attempts),
          SqlValue::Number(row.crashes),
          SqlValue::Number(Number(row.sequence)),
          SqlValue::Text(row.owner),
          SqlValue::Blob(BytesOf(row.error)),
          SqlValue::Number(row.result),
          SqlValue::Number(Micros(row.started)),
          SqlValue::Number(Micros(row.ended))};
}

inline std::vector<SqlValue> ValuesOf(const EventRow& row) {
  return {SqlValue::Number(row.job),          SqlValue::Number(Number(row.sequence)),
          SqlValue::Number(Micros(row.time)), SqlValue::Number(Number(row.state)),
          SqlValue::Number(row.attempt),      SqlValue::Blob(BytesOf(row.error))};
}

inline std::vector<SqlValue> ValuesOf(const RemovalRow& row) {
  return {SqlValue::Number(static_cast<int64_t>(row.kind)), SqlValue::Text(row.tenant),
          SqlValue::Text(row.name)};
}

#define BCCSKEL_UPLOAD_COLUMNS "tenant, name, declaration, size_bytes, job, volume, used, file"
#define BCCSKEL_VOLUME_COLUMNS \
  "tenant, name, declaration, blob_digest, volume_digest, size_bytes, created, used"
#define BCCSKEL_RESULT_COLUMNS "number, tenant, key, file, file_digest, bytes, records, summary"
// Without its number.
#define BCCSKEL_NEW_JOB_COLUMNS                                                \
  "tenant, name, request_id, body, upload, options, priority, threads, trace," \
  "created, volume, state, attempts, crashes, sequence, owner, error, result, started, ended"
#define BCCSKEL_JOB_COLUMNS "number, " BCCSKEL_NEW_JOB_COLUMNS
#define BCCSKEL_EVENT_COLUMNS "job, sequence, time, state, attempt, error"
#define BCCSKEL_REMOVAL_COLUMNS "kind, tenant, name"

inline constexpr const char* TableOf(const UploadRow&) { return "uploads"; }
inline constexpr const char* TableOf(const VolumeRow&) { return "volumes"; }
inline constexpr const char* TableOf(const ResultRow&) { return "results"; }
inline constexpr const char* TableOf(const JobRow&) { return "jobs"; }
inline constexpr const char* TableOf(const EventRow&) { return "events"; }
inline constexpr const char* TableOf(const RemovalRow&) { return "removals"; }

// What the row should have in its column row_check.
template <typename Row>
int64_t CheckOf(const Row& row) {
  return ChecksumOf(TableOf(row), ValuesOf(row));
}

// The same of what was read: the bytes as they are, the kinds as they should be.
template <typename Row>
int64_t CheckOf(const SqlRow& from, const Row& row) {
  std::vector<SqlValue> values = ValuesOf(Row());
  for (size_t n = 0; n < values.size(); ++n) {
    values[n].number = from.values()[n].number;
    values[n].bytes = from.values()[n].bytes;
  }
  return ChecksumOf(TableOf(row), values);
}

// What is read of a row.
#define BCCSKEL_SELECT(table, columns) "SELECT " columns ", row_check FROM " table " "
#define BCCSKEL_SELECT_UPLOAD BCCSKEL_SELECT("uploads", BCCSKEL_UPLOAD_COLUMNS)
#define BCCSKEL_SELECT_VOLUME BCCSKEL_SELECT("volumes", BCCSKEL_VOLUME_COLUMNS)
#define BCCSKEL_SELECT_RESULT BCCSKEL_SELECT("results", BCCSKEL_RESULT_COLUMNS)
#define BCCSKEL_SELECT_JOB BCCSKEL_SELECT("jobs", BCCSKEL_JOB_COLUMNS)
#define BCCSKEL_SELECT_EVENT BCCSKEL_SELECT("events", BCCSKEL_EVENT_COLUMNS)
#define BCCSKEL_SELECT_REMOVAL BCCSKEL_SELECT("removals", BCCSKEL_REMOVAL_COLUMNS)

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_ROW_COLUMNS_H_
