#include "batch/database.hpp"

#include <sqlite3.h>

#include <filesystem>
#include <memory>

#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kSchema[] =
    "CREATE TABLE runs(row INTEGER PRIMARY KEY, name TEXT, inputs TEXT, settings TEXT, subject TEXT, key "
    "TEXT,"
    " version TEXT, build TEXT, status TEXT NOT NULL, reason TEXT, message TEXT, seconds REAL, cpu_seconds "
    "REAL,"
    " peak_MB REAL);"
    "CREATE TABLE figures(row INTEGER NOT NULL REFERENCES runs(row), figure TEXT NOT NULL, value,"
    " PRIMARY KEY(row, figure)) WITHOUT ROWID;";

class Database {
 public:
  explicit Database(const std::string& file) : file_(file) {
    sqlite3* handle = nullptr;
    const int code = sqlite3_open(file.c_str(), &handle);
    handle_.reset(handle);
    if (code != SQLITE_OK) fail();
    run("PRAGMA journal_mode=OFF; PRAGMA synchronous=NORMAL; BEGIN;");  // a new file: all of it or none
    run(kSchema);
  }

  void run(const char* sql) {
    if (sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }

  [[noreturn]] void fail() const {
    throw geometry::Refusal(geometry::refusal::kCannotWrite, file_ + ": " + sqlite3_errmsg(handle_.get()));
  }

  sqlite3* handle() const { return handle_.get(); }

 private:
  std::string file_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> handle_{nullptr, sqlite3_close};
};

class Statement {
 public:
  Statement(Database& database, const char* sql) : database_(database) {
    sqlite3_stmt* handle = nullptr;
    if (sqlite3_prepare_v2(database.handle(), sql, -1, &handle, nullptr) != SQLITE_OK) database.fail();
    handle_.reset(handle);
  }

  Statement& operator<<(const std::string& text) {
    sqlite3_bind_text(handle_.get(), ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Statement& operator<<(double value) {
    sqlite3_bind_double(handle_.get(), ++bound_, value);
    return *this;
  }
  Statement& operator<<(std::size_t value) {
    sqlite3_bind_int64(handle_.get(), ++bound_, static_cast<sqlite3_int64>(value));
    return *this;
  }
  Statement& operator<<(const Json& value) {
    if (value.is_null()) {
      sqlite3_bind_null(handle_.get(), ++bound_);
      return *this;
    }
    if (value.is_number()) return *this << value.get<double>();
    return *this << (value.is_string() ? value.get<std::string>() : value.dump());
  }

  void done() {
    if (sqlite3_step(handle_.get()) != SQLITE_DONE) database_.fail();
    sqlite3_reset(handle_.get());
    bound_ = 0;
  }

 private:
  Database& database_;
  int bound_ = 0;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> handle_{nullptr, sqlite3_finalize};
};

void fill(const std::string& file, const Table& table) {
  Database database(file);
  Statement run(database, "INSERT INTO runs VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  Statement figure(database, "INSERT OR REPLACE INTO figures VALUES(?,?,?)");
  for (const auto& [row, line] : table.lines) {
    run << row;
    for (const char* column : {"name", "inputs", "settings", "subject", "key", "version", "build", "status"})
      run << line.value(column, Json());
    const Json reason = line.value("reason", Json()), cost = line.value("cost", Json());
    for (const char* part : {"code", "message"})
      run << (reason.is_object() ? reason.value(part, Json()) : Json());
    for (const char* part : {"seconds", "cpu_seconds", "peak_MB"})
      run << (cost.is_object() ? cost.value(part, Json()) : Json());
    run.done();
    for (const Figure& one : figures_of(line.value("result", Json::object()))) {
      figure << row << one.first;
      std::visit([&figure](const auto& value) { figure << value; }, one.second);
      figure.done();
    }
  }
  database.run("COMMIT");
}

}  // namespace

void write_database(const Table& table, const std::string& file) {
  const std::string unfinished = file + ".unfinished";
  std::error_code error;
  std::filesystem::remove(unfinished, error);
  try {
    fill(unfinished, table);
    std::filesystem::rename(unfinished, file, error);
    if (error) throw geometry::Refusal(geometry::refusal::kCannotWrite, file + ": " + error.message());
  } catch (...) {
    std::filesystem::remove(unfinished, error);  // it holds measures
    throw;
  }
}

}  // namespace tensegric_fit::batch
