#pragma once
// Values that can be read but cannot be: sizes of the wrong unit, samples beyond their specimen, dead channels, protocols that are no
// speeds. Each is an InputError with file, line and field. Test: plausible_test.

#include "base/yaml_file.h"
#include "reconcile/csv_table.h"
#include "reconcile/dataset.h"

namespace filum::reconcile {

/// A size of a specimen [SI] within what the catalogue holds for possible. Those ranges span a factor of 1000 at most, so that a unit
/// wrong by 1000 always leads out of them; the refusal then names the unit that was meant.
double plausible_size(const YamlNode& node, const KeyInfo& key);

/// A field of free form (`layers`, `cycle`, `rate`, `markers`, `layer_split`): what begins like a number must be one that fits the key.
void check_free_text(const YamlNode& node, const KeyInfo& key, Dataset& d);

/// The specimen of a trial as a whole. `own`, `common`: the maps that may have given its sizes, of the trial and of the dataset.
void check_specimen(const YamlNode& own, const YamlNode& common, Rig rig, const Trial& t);

/// The samples of a trial as they were read, before rows are left out.
void check_samples(Dataset& d, const Trial& t, const CsvTable& table);

/// Over all trials: an output that never answers, inputs that never move. A still hand has no inputs: an axis that its sensor does not
/// measure is left out.
void check_constant(Dataset& d);

/// Over all trials: a stated noise far beyond all that its channel ever says, beside which nothing could be seen.
void check_noise(const Dataset& d);

}  // namespace filum::reconcile
