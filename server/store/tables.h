#ifndef BCCSKEL_SERVER_STORE_TABLES_H_
#define BCCSKEL_SERVER_STORE_TABLES_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/store/rows.h"
#include "server/store/sql_database.h"
#include "server/store/stored_bytes.h"

namespace bccskel::server {

// Maps rows to table columns, each named once. Part of job_store.cc.

using Kind = SqlValue::Kind;

inline constexpr const char* TableOf(const UploadRow&) { return "uploads"; }
template <typename Visit>
void ForEachColumn(UploadRow& row, Visit&& visit) {
  visit("tenant", row.tenant);
  visit("name", row.name);
  visit("declaration", row.declaration, Kind::kBlob);
  visit("size_bytes", row.size_bytes);
  visit("job", row.job);
  visit("volume", row.volume);
  visit("used", row.used);
  visit("file", row.file);
}

inline constexpr const char* TableOf(const VolumeRow&) { return "volumes"; }
template <typename Visit>
void ForEachColumn(VolumeRow& row, Visit&& visit) {
  visit("tenant", row.tenant);
  visit("name", row.name);
  visit("declaration", row.declaration, Kind::kBlob);
  visit("blob_digest", row.blob_digest);
  visit("volume_digest", row.volume_digest);
  visit("size_bytes", row.size_bytes);
  visit("created", row.created);
  visit("used", row.used);
}

inline constexpr const char* TableOf(const ResultRow&) { return "results"; }
template <typename Visit>
void ForEachColumn(ResultRow& row, Visit&& visit) {
  visit("number", row.number);
  visit("tenant", row.tenant);
  visit("key", row.key);
  visit("file", row.file);
  visit("file_digest", row.file_digest);
  visit("bytes", row.bytes);
  visit("records", row.records);
  visit("summary", row.summary, Kind::kBlob);
}

inline constexpr const char* TableOf(const JobRow&) { return "jobs"; }
template <typename Visit>
void ForEachColumn(JobRow& row, Visit&& visit) {
  visit("number", row.number);
  visit("tenant", row.tenant);
  visit("name", row.name);
  visit("request_id", row.request_id);
  visit("body", row.body, Kind::kBlob);
  visit("upload", row.upload);
  visit("options", row.options, Kind::kBlob);
  visit("priority", row.priority);
  visit("threads", row.threads);
  visit("trace", row.trace);
  visit("created", row.created);
  visit("volume", row.volume);
  visit("state", row.state);
  visit("attempts", row.attempts);
  visit("crashes", row.crashes);
  visit("sequence", row.sequence);
  visit("owner", row.owner);
  visit("error", row.error);
  visit("result", row.result);
  visit("started", row.started);
  visit("ended", row.ended);
}

inline constexpr const char* TableOf(const EventRow&) { return "events"; }
template <typename Visit>
void ForEachColumn(EventRow& row, Visit&& visit) {
  visit("job", row.job);
  visit("sequence", row.sequence);
  visit("time", row.time);
  visit("state", row.state);
  visit("attempt", row.attempt);
  visit("error", row.error);
}

inline constexpr const char* TableOf(const RemovalRow&) { return "removals"; }
template <typename Visit>
void ForEachColumn(RemovalRow& row, Visit&& visit) {
  visit("kind", row.kind);
  visit("tenant", row.tenant);
  visit("name", row.name);
}

template <typename Number>
concept IsNumber = std::is_integral_v<Number> || std::is_enum_v<Number>;

inline int64_t Micros(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}
// Any number is valid input, since damage may have made it.
inline Time TimeOf(int64_t micros) {
  constexpr uint64_t kPerMicro = std::chrono::nanoseconds(std::chrono::microseconds(1)).count();
  return Time(Time::duration(static_cast<int64_t>(static_cast<uint64_t>(micros) * kPerMicro)));
}

// Convert a field to its stored value.
template <IsNumber Number>
SqlValue ToValue(Number number) {
  return SqlValue::Number(static_cast<int64_t>(number));
}
inline SqlValue ToValue(std::string text) { return SqlValue::Text(std::move(text)); }
inline SqlValue ToValue(Time time) { return SqlValue::Number(Micros(time)); }
inline SqlValue ToValue(const std::optional<Time>& time) {
  return SqlValue::Number(time.has_value() ? Micros(*time) : 0);
}
inline SqlValue ToValue(const absl::Status& status) { return SqlValue::Blob(BytesOf(status)); }
inline SqlValue ToValue(SqlValue value) { return value; }

// The inverse.
template <IsNumber Number>
void Read(SqlRow& from, Number& number) {
  number = static_cast<Number>(from.Number());
}
inline void Read(SqlRow& from, std::string& text) { text = from.Text(); }
inline void Read(SqlRow& from, Time& time) { time = TimeOf(from.Number()); }
inline void Read(SqlRow& from, std::optional<Time>& time) {
  const int64_t micros = from.Number();
  time = micros == 0 ? std::nullopt : std::optional(TimeOf(micros));
}
inline void Read(SqlRow& from, absl::Status& status) { status = StatusOfBytes(from.Text()); }

template <typename Row>
std::vector<SqlValue> ValuesOf(Row row) {
  std::vector<SqlValue> values;
  ForEachColumn(row, [&values](const char*, auto& field, Kind kind = Kind::kNumber) {
    values.push_back(ToValue(std::move(field)));
    if (kind == Kind::kBlob) values.back().kind = kind;
  });
  return values;
}

// {"tenant", "name", ..., "row_check"}
template <typename Row>
std::vector<std::string> ColumnsOf(Row row) {
  std::vector<std::string> columns;
  ForEachColumn(row, [&columns](const char* name, auto&, Kind = Kind::kNumber) {
    columns.emplace_back(name);
  });
  columns.emplace_back("row_check");
  return columns;
}

// "$1, $2, ..."
inline std::string Parameters(size_t count) {
  std::string list;
  for (size_t n = 1; n <= count; ++n) absl::StrAppend(&list, n == 1 ? "$" : ", $", n);
  return list;
}

// The end of an INSERT that replaces a row with the same `key` but keeps its number.
inline std::string Replacing(const std::string& key, const std::vector<std::string>& columns) {
  const std::set<std::string> kept = absl::StrSplit(key + ", number", ", ");
  std::string clause = absl::StrCat(" ON CONFLICT(", key, ") DO UPDATE SET ");
  const char* comma = "";
  for (const std::string& column : columns) {
    if (kept.contains(column)) continue;
    absl::StrAppend(&clause, std::exchange(comma, ", "), column, " = excluded.", column);
  }
  return clause;
}

// The expected value of the row's column row_check.
template <typename Row>
int64_t CheckOf(const Row& row) {
  return ChecksumOf(TableOf(row), ValuesOf(row));
}

// The same for a row as read: its bytes with the expected kinds.
template <typename Row>
int64_t CheckOf(const SqlRow& from, const Row& row) {
  std::vector<SqlValue> values = ValuesOf(Row());
  for (size_t n = 0; n < values.size(); ++n) {
    values[n].number = from.values()[n].number;
    values[n].bytes = from.values()[n].bytes;
  }
  return ChecksumOf(TableOf(row), values);
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_TABLES_H_
