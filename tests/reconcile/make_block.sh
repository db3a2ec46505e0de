# To be sourced by tests: a small dataset of a block of brain, 5 mm cubed and of 2 kPa, so 10 mN a mm, pressed by 0.5 mm and held.
# make_block FOLDER SHARE TIME [STEPS [SEED [RUNS]]]: F = E A/h (u - share q), q' = (u - q)/time, STEPS of 0.02 s; a sum of twelve uniform
# numbers from SEED on is the noise, 0.02 mN. RUNS: name, speed [mm/s] and letter of its replicates each.
make_block() {
  local folder=$1 share=$2 time=$3 steps=${4:-300} seed=${5:-1} runs=${6:-a:1:A b:1:A c:4:B} run name speed letter
  mkdir -p "$folder"
  cat >"$folder/experiment.yaml" <<'YAML'
format: filum-experiment/1
title: Block
source: made by the test
rig: tissue-block
specimen: { shape: cuboid, length: "5 mm", width: "5 mm", height: "5 mm" }
model: { file: brain/linear, free: [youngs_modulus] }
channels:
  - { name: time, column: t, unit: s }
  - { name: displacement, column: u, unit: mm, kind: input }
  - { name: force, column: F, unit: mN, kind: output, noise: "0.02 mN" }
trials:
YAML
  for run in $runs; do
    IFS=: read -r name speed letter <<<"$run"
    echo "  - { file: $name.csv, protocol: { mode: compression, rate: \"$speed mm/s\" }, repeat: $letter }" >>"$folder/experiment.yaml"
    awk -v speed="$speed" -v seed="$seed" -v g="$share" -v time="$time" -v steps="$steps" 'BEGIN { srand(seed); print "t,u,F"; h = 0.02; d = h / (2 * time); q = 0
      for (i = 0; i <= steps; ++i) { t = i * h; u = speed * t; if (u > 0.5) u = 0.5; u = -u
        if (i > 0) q = (q * (1 - d) + d * (u + last)) / (1 + d); last = u
        n = -6; for (k = 0; k < 12; ++k) n += rand()
        printf "%.4f,%.6f,%.6f\n", t, u, 10 * (u - g * q) + 0.02 * n } }' >"$folder/$name.csv"
    seed=$((seed + 1))
  done
}
