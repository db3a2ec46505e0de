#include "session/ratings.h"

#include <soci/sqlite3/soci-sqlite3.h>

#include <filesystem>
#include <map>
#include <tuple>

#include "base/error.h"
#include "session/database.h"
#include "session/recorder.h"
#include "session/records.h"
#include "session/store.h"

namespace filum {
namespace {

constexpr std::int32_t kRatingsId = 0x46694C72;  // "FiLr"

}  // namespace

struct Ratings::Impl {
  std::string file;
  std::unique_ptr<soci::session> sql;

  void open() {
    const bool there = std::filesystem::exists(file);
    const database::Header header = database::read_header(file);
    if (header.application_id == kRatingsId && header.format > kRatingsFormat)
      throw StoreError(StoreTrouble::kNewer, file, "format", std::to_string(header.format) + ", made by a newer Filum", "a format up to " + std::to_string(kRatingsFormat));
    if (there) database::require_format(file, "the ratings of a Filum store", kRatingsId, kRatingsFormat);
    sql = std::make_unique<soci::session>(soci::sqlite3, database::connection_string(file, false));
    if (there && database::pragma(*sql, "quick_check") != "ok") throw InputError(file, "ratings", "damage", "an undamaged file; restore it from a copy");
    *sql << "CREATE TABLE IF NOT EXISTS filum_marks (entry INTEGER NOT NULL, session VARCHAR(200) NOT NULL, task VARCHAR(100) NOT NULL, scale VARCHAR(100) NOT NULL, "
            "rater VARCHAR(32) NOT NULL, stored_utc VARCHAR(32) NOT NULL, item VARCHAR(100) NOT NULL, points INTEGER NOT NULL)";
    if (!there) database::mark(*sql, kRatingsId, kRatingsFormat);
  }

  void put(const Rating& r) {
    soci::transaction transaction(*sql);
    int entry = 0;
    *sql << "SELECT coalesce(max(entry), 0) + 1 FROM filum_marks", soci::into(entry);
    for (const ItemMark& m : r.marks)
      *sql << "INSERT INTO filum_marks VALUES (:entry, :session, :task, :scale, :rater, :stored, :item, :points)", soci::use(entry), soci::use(r.session),
          soci::use(r.task), soci::use(r.scale), soci::use(r.rater), soci::use(r.stored_utc), soci::use(m.item), soci::use(m.points);
    transaction.commit();
  }

  std::vector<Rating> list(const std::string& session) {
    std::map<std::tuple<std::string, std::string, std::string>, std::pair<int, Rating>> newest;
    int entry = 0;
    Rating row;
    ItemMark mark;
    soci::statement query =
        (sql->prepare << "SELECT entry, session, task, scale, rater, stored_utc, item, points FROM filum_marks WHERE :s = '' OR session = :s ORDER BY entry, rowid",
         soci::use(session, "s"), soci::into(entry), soci::into(row.session), soci::into(row.task), soci::into(row.scale), soci::into(row.rater),
         soci::into(row.stored_utc), soci::into(mark.item), soci::into(mark.points));
    query.execute();
    while (query.fetch()) {
      auto& [number, rating] = newest[{row.session, row.scale, row.rater}];
      if (number != entry) rating = row;
      number = entry;
      rating.marks.push_back(mark);
    }
    std::vector<Rating> all;
    for (auto& [key, one] : newest) all.push_back(std::move(one.second));
    return all;
  }

  /// A database's failures name the file.
  template <class Action>
  auto guarded(Action&& action) {
    try {
      return action();
    } catch (const soci::soci_error& error) {
      throw InputError(file, "ratings", database::reason(error), "a file that can be read and written");
    }
  }
};

Ratings::Ratings(const std::string& folder) : impl_(std::make_unique<Impl>()) {
  impl_->file = (std::filesystem::path(folder) / "ratings.sqlite").string();
  impl_->guarded([&] { impl_->open(); });
}

Ratings::~Ratings() = default;

void Ratings::put(const Rating& rating) {
  if (!is_participant_code(rating.rater)) throw InputError("rating", "rater", "\"" + rating.rater + "\"", "a code of 1 to 32 letters, digits, - or _ (never a name)");
  if (rating.marks.empty()) throw InputError("rating", "marks", "none", "at least one item");
  Rating stamped = rating;
  if (stamped.stored_utc.empty()) stamped.stored_utc = utc_now();
  impl_->guarded([&] { impl_->put(stamped); });
}

std::vector<Rating> Ratings::list(const std::string& session) const {
  return impl_->guarded([&] { return impl_->list(session); });
}

}  // namespace filum
