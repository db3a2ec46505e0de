#pragma once
// The write-ahead log of a recording that was not closed, as SQLite's file format describes it: SQLite takes its frames up to the first with a
// wrong checksum, without a word about those behind. Private to session. Test: tests/session/journal_test.cpp.

#include <string>

namespace filum {

/// What is lost of a log by damage; empty: nothing, or there is no log. A log that just ends, as a kill leaves it, is not damaged.
std::string journal_damage(const std::string& file);

}  // namespace filum
