#include "tools/formats/ros2/sqlite_bag.h"

#include <sqlite3.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "tools/formats/import/byte_file.h"
#include "tools/formats/ros2/cut_database.h"
#include "tools/formats/ros2/packed_message.h"

namespace evit::formats {
namespace {

constexpr char kMagic[] = "SQLite format 3";  // with its zero

// A connection that only reads, and one statement at a time.
class Database {
 public:
  // `cut`: of a file that is shorter than its header says, what is whole.
  explicit Database(const std::string& path, bool cut = false) : path_(path) {
    if (cut) {
      OpenCut();
      return;
    }
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
  // The same of a damaged file, which ends where the damage begins.
  bool StepToDamage() { return sqlite3_step(statement_) == SQLITE_ROW; }
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
  void OpenCut() {
    cut_ = std::make_unique<CutDatabase>(path_);
    const std::int64_t pages = cut_->size();
    if (sqlite3_open_v2(":memory:", &db_, SQLITE_OPEN_READWRITE, nullptr) != SQLITE_OK ||
        sqlite3_deserialize(db_, "main", cut_->data(), pages, pages, SQLITE_DESERIALIZE_READONLY) !=
            SQLITE_OK ||
        sqlite3_exec(db_, "SELECT count(*) FROM sqlite_master", nullptr, nullptr, nullptr) != SQLITE_OK)
      Fail();
    sqlite3_limit(db_, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxMessage));
  }
  [[noreturn]] void Fail() const {
    throw std::runtime_error(path_ + ": is not a complete ROS 2 bag (SQLite: " + sqlite3_errmsg(db_) +
                             "); copy it again, or run ros2 bag reindex on it");
  }

  std::string path_;
  std::unique_ptr<CutDatabase> cut_;  // longer than db_, which lies in it
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

// A bag that was cut off: its messages in the order in which they were written, up to the first that is not
// whole. Indices and counts are not looked at: they may lie behind.
class CutSqlitePass : public MessagePass {
 public:
  CutSqlitePass(const std::string& path, std::map<std::int64_t, std::string> topics, double lost_share)
      : path_(path), db_(path, true), topics_(std::move(topics)), lost_share_(lost_share) {
    db_.Prepare("SELECT topic_id, data, timestamp FROM messages NOT INDEXED ORDER BY rowid");
    bytes_ = static_cast<double>(std::filesystem::file_size(path));
  }
  bool Next(RosMessage* message) override {
    while (db_.StepToDamage()) {
      message->data = db_.Blob(1, &message->size);
      read_ += static_cast<double>(message->size);
      const auto topic = topics_.find(db_.Integer(0));
      if (topic == topics_.end() || message->data == nullptr) continue;
      message->topic = topic->second;
      time_ = db_.Integer(2) / 1000;
      try {
        packed_.Unpack(message);
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(path_ + ": " + message->topic + ": " + error.what());
      }
      return true;
    }
    cut_off_ = true;
    return false;
  }
  double share() const override { return std::min(1.0, read_ / bytes_); }
  bool cut_off() const override { return cut_off_; }
  double lost_share() const override { return lost_share_; }
  Utime time() const { return time_; }  // that the message was recorded at

 private:
  std::string path_;
  Database db_;
  std::map<std::int64_t, std::string> topics_;
  PackedMessages packed_;
  double lost_share_, bytes_ = 1, read_ = 0;
  Utime time_ = 0;
  bool cut_off_ = false;
};

}  // namespace

bool SqliteBag::Recognises(const std::string& path) {
  ByteFile file(path);
  return file.Fill(sizeof kMagic) && file.available() >= sizeof kMagic &&
         std::memcmp(file.data(), kMagic, sizeof kMagic) == 0;
}

SqliteBag::SqliteBag(const std::string& path) : path_(path), lost_share_(CutDatabase::LostShare(path)) {
  Database db(path, lost_share_ > 0);
  db.Prepare("SELECT name, type, serialization_format, id FROM topics NOT INDEXED");
  while (db.Step()) {
    ids_[db.Integer(3)] = db.Text(0);
    std::string type = Ros1TypeName(db.Text(1));
    const std::string encoding = db.Text(2);
    if (encoding != "cdr") type.append(" as ").append(encoding).append(", which is not read");
    topics_.push_back({db.Text(0), type});
  }
  std::sort(topics_.begin(), topics_.end(),
            [](const RosTopic& a, const RosTopic& b) { return a.name < b.name; });
}

std::vector<BagPart> SqliteBag::Parts() const {
  BagPart part{path_, {}};
  if (lost_share_ > 0) {
    CutSqlitePass pass(path_, ids_, lost_share_);
    RosMessage message;
    while (pass.Next(&message)) part.Cover(message.topic, pass.time());
    return {part};
  }
  Database db(path_);
  db.Prepare(
      "SELECT topics.name, min(timestamp), max(timestamp) FROM messages JOIN topics ON messages.topic_id = "
      "topics.id GROUP BY topics.name");
  while (db.Step()) part.topics[db.Text(0)] = {db.Integer(1) / 1000, db.Integer(2) / 1000};
  return {part};
}

std::unique_ptr<MessagePass> SqliteBag::Read(const std::set<std::string>& topics) const {
  if (lost_share_ == 0) return std::make_unique<SqlitePass>(path_, topics);
  std::map<std::int64_t, std::string> taken;
  for (const auto& [id, name] : ids_)
    if (topics.count(name) > 0) taken[id] = name;
  return std::make_unique<CutSqlitePass>(path_, std::move(taken), lost_share_);
}

}  // namespace evit::formats
