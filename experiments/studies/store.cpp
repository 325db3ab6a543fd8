// Reads and writes the tables of the store. Finds the provenance of this process.
#include "experiments/studies/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "commit.h"
#include "core/base/error.h"
#include "core/native/canvas.h"
#include "experiments/method/session.h"
#include "experiments/system/machine.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

// Adds a count to `out`. Adds the fields of a value with fields, and nothing for an empty optional.
template <class Value>
void add(NamedCounts& out, std::string_view name, const Value& value) {
  if constexpr (requires { value.has_value(); }) {
    if (value) add(out, name, *value);
  } else if constexpr (HasFields<Value>) {
    value.fields([&](std::string_view inner, const auto& of) { add(out, inner, of); });
  } else {
    out.emplace_back(name, value);
  }
}

// The tables of a store of version kStoreVersion. The columns for Provenance and PointKey have the
// order of the fields of these structures. `results` is a view for queries in SQL.
constexpr const char* kSchema = R"(
CREATE TABLE runs (
  run INTEGER PRIMARY KEY, started TEXT NOT NULL, commit_id TEXT NOT NULL, gl_vendor TEXT NOT NULL,
  gl_renderer TEXT NOT NULL, gl_version TEXT NOT NULL, cpu TEXT NOT NULL,
  cpu_features TEXT NOT NULL, cores INTEGER NOT NULL, options TEXT NOT NULL) STRICT;
CREATE TABLE studies (
  study TEXT PRIMARY KEY, quick INTEGER NOT NULL, seed INTEGER NOT NULL, shard INTEGER NOT NULL,
  shards INTEGER NOT NULL) STRICT;
CREATE TABLE points (
  study TEXT NOT NULL REFERENCES studies, position INTEGER NOT NULL, scene TEXT NOT NULL,
  method TEXT NOT NULL, "offset" TEXT NOT NULL, radius TEXT NOT NULL, depth_format TEXT NOT NULL,
  depth_mode TEXT NOT NULL, resolution INTEGER NOT NULL, views TEXT NOT NULL,
  frame INTEGER NOT NULL, seed INTEGER NOT NULL, PRIMARY KEY (study, position)) STRICT;
CREATE TABLE rows (
  study TEXT NOT NULL, position INTEGER NOT NULL, run INTEGER NOT NULL REFERENCES runs,
  measured TEXT NOT NULL, device TEXT NOT NULL, counts TEXT NOT NULL, times TEXT NOT NULL,
  left_out TEXT NOT NULL, PRIMARY KEY (study, position),
  FOREIGN KEY (study, position) REFERENCES points) STRICT;
CREATE VIEW results AS
  SELECT points.*, rows.device, rows.counts, rows.times, rows.left_out, rows.measured,
         runs.commit_id, runs.gl_renderer, runs.cpu
  FROM points JOIN rows USING (study, position) JOIN runs USING (run);
)";

Error damaged(const std::string& path, const std::string& what) {
  return Error(path, "is damaged" + what,
               "restore it from a copy, or start anew in another folder");
}

Error refusal(const std::string& path, const SQLite::Exception& error) {
  const std::string text = error.getErrorStr();
  switch (error.getErrorCode() & 0xff) {
    case SQLITE_NOTADB:
      return Error(path, "is no store of farcull (" + text + ")",
                   "name another folder, or move the file away");
    case SQLITE_CORRUPT:
      return damaged(path, " (" + text + ")");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Error(path, "another program is writing it",
                   "wait for its end, or name another folder");
    case SQLITE_FULL:
    case SQLITE_IOERR:
      return Error(
          path, "cannot be written: " + text,
          "make room on the disk; the rows before are kept, --resume goes on with the next");
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return Error(path, "cannot be opened: " + text,
                   "look whether the folder is there and may be written");
    default:
      return Error(path, text, "name another folder, or move the file away");
  }
}

template <class Work>
auto guarded(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw refusal(path, error);
  }
}

std::int64_t stored(std::uint64_t number, const char* what) {
  if (number > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    throw Error(what, std::to_string(number) + " is too large to be stored",
                "give at most 2^63 - 1");
  return static_cast<std::int64_t>(number);
}

Json parsed(const std::string& path, const std::string& text) {
  Json out = Json::parse(text, nullptr, false);
  if (!out.is_object()) throw damaged(path, ": counts or times of a row are no JSON object");
  return out;
}

// Returns the JSON as text. Replaces invalid UTF-8, which names of GL drivers may contain.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Binds the fields of a row to the statement's parameters, in order, starting at parameter `at`.
template <class Fields>
void bind_fields(SQLite::Statement& statement, int at, const Fields& row) {
  row.fields([&](std::string_view name, const auto& value) {
    if constexpr (std::is_unsigned_v<std::decay_t<decltype(value)>>) {
      statement.bind(at++, stored(value, ("--" + std::string(name)).c_str()));
    } else if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>) {
      statement.bind(at++, static_cast<std::int64_t>(value));
    } else if constexpr (requires { value.has_value(); }) {
      statement.bind(at++, column_text(value));
    } else {
      statement.bind(at++, value);
    }
  });
}

// Reads the fields of a row from the statement's columns, starting at column `at`.
template <class Fields>
Fields read_fields(SQLite::Statement& statement, int at) {
  Fields out;
  const auto read = [&](auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const SQLite::Column column = statement.getColumn(at++);
    if constexpr (std::is_same_v<Value, std::string>) {
      value = column.getString();
    } else if constexpr (requires { value.has_value(); }) {
      value = column_of<typename Value::value_type>(column.getString());
    } else {
      value = static_cast<Value>(column.getInt64());
    }
  };
  std::apply([&](auto&... value) { (read(value), ...); }, out.members());
  return out;
}

std::string grid_text(const GridChoice& choice) {
  return fmt::format("the {} grid with seed {}", choice.quick ? "quick" : "full", choice.seed);
}

}  // namespace

// ---- typed counts and times as the values in a row of a store ----

NamedCounts to_columns(const Counts& counts) {
  NamedCounts out;
  std::visit(
      [&](const auto& of) {
        using Of = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Of, LibraryCounts>)
          out = of.values;
        else if constexpr (HasFields<Of>)
          add(out, "", of);
      },
      counts);
  return out;
}

Measurement stored(const PointResult& result) {
  Measurement out{.device = result.device, .left_out = result.left_out};
  for (const auto& [name, value] : to_columns(result.counts))
    std::visit([&, &key = name](const auto& of) { out.counts[key] = of; }, value);
  result.times.fields([&](std::string_view name, const std::optional<double>& ms) {
    if (ms) out.times[std::string(name)] = *ms;
  });
  return out;
}

bool breaks_promise(const Measurement& measurement) {
  const Json& counts = measurement.counts;
  if (!counts.value("promises", false)) return false;
  // A contestant that does not answer breaks its guarantee.
  for (const char* count : {"missed", "missed_pairs", "wrong", "violations", "refused",
                            "unanswered", "not_asked", "crashed", "hung", "no_memory"}) {
    if (counts.value(count, std::uint64_t{0}) > 0) return true;
  }
  return false;
}

std::optional<int> rounds_in(const Measurement& row) {
  const auto rounds = row.times.find("rounds");
  if (rounds == row.times.end() || !rounds->is_array()) return std::nullopt;
  return static_cast<int>(rounds->size());
}

bool is_whole(const Measurement& row) {
  return rounds_in(row).value_or(kRounds) >= kRounds || row.times.value("no_times", false);
}

bool StoredStudy::complete() const {
  return rows.size() == declaration.points.size() &&
         std::ranges::all_of(rows, [](const Row& row) { return is_whole(row.measurement); });
}

Provenance provenance_now(const std::string& device, const std::string& options) {
  Provenance out{.started = utc_now(),
                 .commit = FARCULL_COMMIT,
                 .cpu = cpu_model(),
                 .cpu_features = cpu_features(),
                 .cores = usable_cores(),
                 .options = options};
  Session session(device);
  if (session.canvas_device().native) {
    out.gl_renderer = "native (" + lane_target() + ")";
  } else {
    const GlInfo& gl = session.context().info();
    out.gl_vendor = gl.vendor;
    out.gl_renderer = gl.renderer;
    out.gl_version = gl.version;
  }
  return out;
}

struct Store::State {
  std::string path;
  SQLite::Database database;
};

Store::Store(const std::string& path, Access access) {
  const bool write = access != Access::read;
  struct stat info = {};
  const bool there = ::stat(path.c_str(), &info) == 0;
  if (there && !S_ISREG(info.st_mode))
    throw Error(path, "is no file", "name another folder for the results");
  if (!there && !write) {
    throw Error(path, std::string("cannot be opened: ") + std::strerror(errno),
                "measure first: farcull experiment all --quick");
  }
  guarded(path, [&] {
    // Opens the file for writing even if Access is `read`, since SQLite first rolls back unfinished
    // transactions of a killed program.
    const int flags = SQLite::OPEN_READWRITE | (write ? SQLite::OPEN_CREATE : 0);
    // SQLite would interpret a name that begins with "file:" as a URI.
    const std::string name = path.starts_with('/') ? path : "./" + path;
    state_ = std::make_unique<State>(State{path, SQLite::Database(name, flags)});
    SQLite::Database& database = state_->database;
    database.exec("PRAGMA foreign_keys = ON");
    if (access == Access::write_at_once) database.exec("PRAGMA journal_mode = MEMORY");
    // Locks out other programs until the file is closed or this program ends for any reason.
    if (write) database.exec("PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE");
    const std::int32_t id = database.execAndGet("PRAGMA application_id").getInt();
    const std::int32_t version = database.execAndGet("PRAGMA user_version").getInt();
    const int tables = database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt();
    if (id == 0 && version == 0 && tables == 0) {
      if (!write) {
        throw Error(path, "holds nothing yet", "measure first: farcull experiment all --quick");
      }
      database.exec(kSchema);
      database.exec(fmt::format("PRAGMA application_id = {}", kStoreId));
      database.exec(fmt::format("PRAGMA user_version = {}", kStoreVersion));
    } else if (id != kStoreId) {
      throw Error(path, "is a database of another program",
                  "name another folder, or move the file away");
    } else if (version != kStoreVersion) {
      throw Error(path,
                  fmt::format("is a store of version {}, and this farcull knows {}", version,
                              kStoreVersion),
                  "use the farcull that made it, or start anew in another folder");
    }
    if (write) database.exec("COMMIT");
    std::string sound = database.execAndGet("PRAGMA integrity_check(1)").getString();
    if (SQLite::Statement(database, "PRAGMA foreign_key_check").executeStep())
      sound = "rows without their point or run";
    if (sound != "ok") throw damaged(path, " (" + sound + ")");
  });
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

const std::string& Store::path() const { return state_->path; }

std::int64_t Store::begin_run(const Provenance& provenance) {
  return guarded(state_->path, [&] {
    SQLite::Statement insert(state_->database,
                             "INSERT INTO runs VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    bind_fields(insert, 1, provenance);
    insert.exec();
    return static_cast<std::int64_t>(state_->database.getLastInsertRowid());
  });
}

std::vector<std::pair<std::int64_t, Provenance>> Store::runs() const {
  return guarded(state_->path, [&] {
    std::vector<std::pair<std::int64_t, Provenance>> out;
    SQLite::Statement select(state_->database, "SELECT * FROM runs ORDER BY run");
    while (select.executeStep())
      out.push_back({select.getColumn(0).getInt64(), read_fields<Provenance>(select, 1)});
    return out;
  });
}

std::vector<std::string> Store::studies() const {
  return guarded(state_->path, [&] {
    std::vector<std::string> out;
    SQLite::Statement select(state_->database, "SELECT study FROM studies ORDER BY rowid");
    while (select.executeStep()) out.push_back(select.getColumn(0).getString());
    return out;
  });
}

std::optional<Declaration> Store::declaration(const std::string& study) const {
  return guarded(state_->path, [&]() -> std::optional<Declaration> {
    SQLite::Statement select(state_->database,
                             "SELECT quick, seed, shard, shards FROM studies WHERE study = ?");
    select.bind(1, study);
    if (!select.executeStep()) return std::nullopt;
    Declaration out{.study = study,
                    .choice = {.quick = select.getColumn(0).getInt() != 0,
                               .seed = static_cast<std::uint64_t>(select.getColumn(1).getInt64())},
                    .shard = select.getColumn(2).getInt(),
                    .of = select.getColumn(3).getInt(),
                    .points = {}};
    SQLite::Statement points(state_->database,
                             "SELECT * FROM points WHERE study = ? ORDER BY position");
    points.bind(1, study);
    while (points.executeStep()) {
      if (points.getColumn(1).getInt64() != static_cast<std::int64_t>(out.points.size()))
        throw damaged(state_->path, ": points of " + study + " are missing");
      out.points.push_back(read_fields<PointKey>(points, 2));
    }
    return out;
  });
}

void Store::declare(const Declaration& wanted) {
  const auto otherwise = [&](const std::string& what) {
    throw Error(state_->path, wanted.study + " stands there with " + what,
                "measure it into another folder (--out)");
  };
  if (const std::optional<Declaration> known = declaration(wanted.study)) {
    if (known->choice.quick != wanted.choice.quick || known->choice.seed != wanted.choice.seed)
      otherwise(grid_text(known->choice) + ", not " + grid_text(wanted.choice));
    if (known->shard != wanted.shard || known->of != wanted.of)
      otherwise(
          fmt::format("shard {}/{}, not {}/{}", known->shard, known->of, wanted.shard, wanted.of));
    if (known->points != wanted.points) otherwise("other points: of another version of farcull");
    return;
  }
  guarded(state_->path, [&] {
    SQLite::Transaction transaction(state_->database);
    SQLite::Statement study(state_->database, "INSERT INTO studies VALUES (?, ?, ?, ?, ?)");
    study.bind(1, wanted.study);
    study.bind(2, wanted.choice.quick ? 1 : 0);
    study.bind(3, stored(wanted.choice.seed, "--seed"));
    study.bind(4, wanted.shard);
    study.bind(5, wanted.of);
    study.exec();
    SQLite::Statement insert(state_->database,
                             "INSERT INTO points VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < wanted.points.size(); ++i) {
      insert.reset();
      insert.bind(1, wanted.study);
      insert.bind(2, static_cast<std::int64_t>(i));
      bind_fields(insert, 3, wanted.points[i]);
      insert.exec();
    }
    transaction.commit();
  });
}

void Store::add(const std::string& study, std::int64_t run, std::size_t position,
                const Measurement& measurement) {
  add(study, {.position = position,
              .point = {},
              .measurement = measurement,
              .run = run,
              .measured = utc_now()});
}

void Store::add(const std::string& study, const Row& row) {
  guarded(state_->path, [&] {
    // One statement is one transaction. This statement replaces a row that says why nothing was
    // measured, lacks rounds or has void rounds.
    static const std::string text = fmt::format(
        "INSERT INTO rows VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT (study, position) DO UPDATE "
        "SET run = excluded.run, measured = excluded.measured, device = excluded.device, counts = "
        "excluded.counts, times = excluded.times, left_out = excluded.left_out WHERE rows.left_out "
        "!= '' OR json_array_length(rows.times, '$.rounds') < {} OR EXISTS (SELECT * FROM "
        "json_each(rows.times, '$.rounds') WHERE json_extract(value, '$.void'))",
        kRounds);
    SQLite::Statement insert(state_->database, text);
    insert.bind(1, study);
    insert.bind(2, static_cast<std::int64_t>(row.position));
    insert.bind(3, row.run);
    insert.bind(4, row.measured);
    insert.bind(5, row.measurement.device);
    insert.bind(6, text_of(row.measurement.counts));
    insert.bind(7, text_of(row.measurement.times));
    insert.bind(8, row.measurement.left_out);
    if (insert.exec() == 0) {
      throw Error(state_->path,
                  fmt::format("point {} of {} has its row already", row.position, study),
                  "let one program at a time measure into it");
    }
  });
}

void Store::together(const std::function<void()>& work) {
  guarded(state_->path, [&] {
    SQLite::Transaction transaction(state_->database);
    work();
    transaction.commit();
  });
}

StoredStudy Store::study(const std::string& name) const {
  std::optional<Declaration> declared = declaration(name);
  if (!declared) {
    throw Error(state_->path, "holds no study '" + name + "'",
                "measure it first: farcull experiment " + name);
  }
  StoredStudy out{.declaration = std::move(*declared), .rows = {}};
  guarded(state_->path, [&] {
    SQLite::Statement select(state_->database,
                             "SELECT position, run, measured, device, counts, times, left_out "
                             "FROM rows WHERE study = ? ORDER BY position");
    select.bind(1, name);
    while (select.executeStep()) {
      const auto text = [&](int column) { return select.getColumn(column).getString(); };
      const auto position = static_cast<std::size_t>(select.getColumn(0).getInt64());
      if (position >= out.declaration.points.size())
        throw damaged(state_->path, ": a row of " + name + " has no point");
      Measurement measurement{.device = text(3), .left_out = text(6)};
      measurement.counts = parsed(state_->path, text(4));
      measurement.times = parsed(state_->path, text(5));
      out.rows.push_back({.position = position,
                          .point = out.declaration.points[position],
                          .measurement = std::move(measurement),
                          .run = select.getColumn(1).getInt64(),
                          .measured = text(2)});
    }
  });
  return out;
}

std::string device_folder(const std::string& folder, const std::string& device) {
  const bool plain = !device.empty() && std::ranges::all_of(device, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
  if (!plain) {
    throw Error(
        "--devices", "'" + device + "' is no device",
        "give all, or some of native, hardware, software and numbers, as in native,software");
  }
  return folder + "/on-" + device;
}

std::string store_path(const std::string& folder, int shard, int of) {
  if (of == 1) return folder + "/results.sqlite";
  return fmt::format("{}/results-{}-of-{}.sqlite", folder, shard, of);
}

}  // namespace farcull
