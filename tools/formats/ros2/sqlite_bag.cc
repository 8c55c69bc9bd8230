#include "tools/formats/ros2/sqlite_bag.h"

#include <sqlite3.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "tools/formats/import/byte_file.h"
#include "tools/formats/ros2/packed_message.h"

namespace evit::formats {
namespace {

constexpr char kMagic[] = "SQLite format 3";  // with its zero

// A connection that only reads, and one statement at a time.
class Database {
 public:
  explicit Database(const std::string& path) : path_(path) {
    // Beside a journal that was left behind, SQLite wants to write; a bag on a medium that does not allow
    // that is opened as it is.
    if (!Open(path, SQLITE_OPEN_READONLY)) {
      std::string escaped;
      for (const char c : path) {
        char hex[8];
        std::snprintf(hex, sizeof hex, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
        escaped += hex;
      }
      if (!Open("file:" + escaped + "?immutable=1", SQLITE_OPEN_READONLY | SQLITE_OPEN_URI)) Fail();
    }
    sqlite3_limit(db_, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxMessage));
  }
  ~Database() {
    sqlite3_finalize(statement_);
    sqlite3_close(db_);
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void Prepare(const std::string& sql) {
    sqlite3_finalize(statement_);
    statement_ = nullptr;
    if (sqlite3_prepare_v2(db_, sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) Fail();
  }
  void Bind(int index, const std::string& text) {
    sqlite3_bind_text(statement_, index, text.c_str(), -1, SQLITE_TRANSIENT);
  }
  bool Step() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) Fail();
    return result == SQLITE_ROW;
  }
  std::string Text(int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return text != nullptr ? text : "";
  }
  std::int64_t Integer(int column) { return sqlite3_column_int64(statement_, column); }
  const std::uint8_t* Blob(int column, std::size_t* size) {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
    *size = data == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return data;
  }

 private:
  bool Open(const std::string& name, int flags) {
    sqlite3_close(db_);
    db_ = nullptr;
    return sqlite3_open_v2(name.c_str(), &db_, flags, nullptr) == SQLITE_OK &&
           sqlite3_exec(db_, "SELECT count(*) FROM sqlite_master", nullptr, nullptr, nullptr) == SQLITE_OK;
  }
  [[noreturn]] void Fail() const {
    throw std::runtime_error(path_ + ": is not a complete ROS 2 bag (SQLite: " + sqlite3_errmsg(db_) +
                             "); copy it again, or run ros2 bag reindex on it");
  }

  std::string path_;
  sqlite3* db_ = nullptr;
  sqlite3_stmt* statement_ = nullptr;
};

class SqlitePass : public MessagePass {
 public:
  SqlitePass(const std::string& path, const std::set<std::string>& topics) : path_(path), db_(path) {
    std::string in;
    for (std::size_t k = 0; k < topics.size(); ++k) in += k == 0 ? "?" : ",?";
    const std::string from =
        " FROM messages JOIN topics ON messages.topic_id = topics.id WHERE topics.name IN (" + in + ")";
    Prepare("SELECT count(*)" + from, topics);
    if (db_.Step()) total_ = db_.Integer(0);
    Prepare("SELECT topics.name, messages.data" + from + " ORDER BY messages.timestamp", topics);
  }
  bool Next(RosMessage* message) override {
    if (!db_.Step()) return false;
    ++read_;
    message->topic = db_.Text(0);
    message->data = db_.Blob(1, &message->size);
    try {
      packed_.Unpack(message);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(path_ + ": " + message->topic + ": " + error.what());
    }
    return true;
  }
  double share() const override {
    return total_ > 0 ? static_cast<double>(read_) / static_cast<double>(total_) : 1;
  }

 private:
  void Prepare(const std::string& sql, const std::set<std::string>& topics) {
    db_.Prepare(sql);
    int index = 0;
    for (const std::string& topic : topics) db_.Bind(++index, topic);
  }
  std::string path_;
  Database db_;
  PackedMessages packed_;
  std::int64_t read_ = 0, total_ = 0;
};

}  // namespace

bool SqliteBag::Recognises(const std::string& path) {
  ByteFile file(path);
  return file.Fill(sizeof kMagic) && file.available() >= sizeof kMagic &&
         std::memcmp(file.data(), kMagic, sizeof kMagic) == 0;
}

SqliteBag::SqliteBag(const std::string& path) : path_(path) {
  Database db(path);
  db.Prepare("SELECT name, type, serialization_format FROM topics ORDER BY name");
  while (db.Step()) {
    const std::string type = Ros1TypeName(db.Text(1)), encoding = db.Text(2);
    topics_.push_back(
        {db.Text(0), encoding == "cdr" ? type : type + " as " + encoding + ", which is not read"});
  }
}

std::vector<BagPart> SqliteBag::Parts() const {
  Database db(path_);
  db.Prepare(
      "SELECT topics.name, min(timestamp), max(timestamp) FROM messages JOIN topics ON messages.topic_id = "
      "topics.id GROUP BY topics.name");
  BagPart part{path_, {}};
  while (db.Step()) part.topics[db.Text(0)] = {db.Integer(1) / 1000, db.Integer(2) / 1000};
  return {part};
}

std::unique_ptr<MessagePass> SqliteBag::Read(const std::set<std::string>& topics) const {
  return std::make_unique<SqlitePass>(path_, topics);
}

}  // namespace evit::formats
