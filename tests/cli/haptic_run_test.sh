#!/bin/bash
# A whole run on the haptic link: the reference client of hardware/haptic-link moves the tool by UDP at 1 kHz and gets forces back, a stranger
# floods the port, another program hears the tools' poses by OpenIGTLink. Usage: haptic_run_test.sh FILUM HAPTIC_CLIENT
filum=$1 client=$2
work=$(mktemp -d)
jobs_=()
trap 'for j in "${jobs_[@]}"; do kill "$j" 2>/dev/null; done; rm -rf "$work"' EXIT
fail() { echo "haptic_run_test: $*"; cat "$work"/*.err "$work"/*.out 2>/dev/null; exit 1; }
port=$((20000 + RANDOM % 20000))
"$filum" run trace --input haptic:$port --motion-scale 0.5 --igtl-out $((port + 1)) --record "$work/session" --longest 5 --json >"$work/run.json" 2>"$work/run.err" &
run=$!
jobs_+=("$run")
"$client" --port $port --seconds 4.5 >"$work/client.out" 2>"$work/client.err" &
master=$!
jobs_+=("$master")
cat >"$work/peers.mjs" <<'JS'
import { createSocket } from "node:dgram";
import { connect } from "node:net";
const [port, igtl] = process.argv.slice(2).map(Number);
const flood = createSocket("udp4");
let sent = 0, heard = 0;
setTimeout(() => {
  const timer = setInterval(() => { for (let k = 0; k < 50; ++k, ++sent) flood.send(Buffer.alloc(60, k), port, "127.0.0.1"); }, 2);
  const ear = connect(igtl, "127.0.0.1").on("error", () => undefined).on("data", (data) => { heard += data.toString("latin1").split("TRANSFORM").length - 1; });
  setTimeout(() => { clearInterval(timer); ear.destroy(); flood.close(); console.log(sent, heard); }, 2500);
}, 1000);
JS
node "$work/peers.mjs" $port $((port + 1)) >"$work/peers.out" 2>"$work/peers.err" &
peers=$!
jobs_+=("$peers")
wait "$peers" || fail "the stranger"
wait "$master" || fail "no force came back"
wait "$run" || fail "the run exited with $?"
read -r flooded heard <"$work/peers.out"
[ "$flooded" -gt 1000 ] || fail "no flood: $flooded packets"
[ "$heard" -gt 20 ] || fail "only $heard poses were heard by OpenIGTLink"
"$filum" export "$work/session" --format csv --out "$work/csv" >/dev/null 2>"$work/export.err" || fail "export"
# The hand starts with a step to its circle of 4 mm: one that swings goes no further than twice that.
node -e '
  const rows = require("fs").readFileSync(process.argv[1] + "/samples.csv", "utf8").split("\n").filter((l) => l && !l.startsWith("#")), head = rows[0].split(",");
  const at = (name) => head.findIndex((h) => h.split(" ")[0] === name), x = rows.slice(1).map((r) => Number(r.split(",")[at("p_x")]));
  if (!(x.length > 2000 && x.every((v) => Math.abs(v) < 8e-3))) { console.error("samples", x.length, Math.max(...x)); process.exit(1); }
  console.log(`${x.length} samples of the hand`);' "$work/csv" >"$work/samples.out" || fail "samples: $(ls "$work/csv"; head -2 "$work/csv"/samples*)"
"$filum" replay "$work/session" --json | grep -q '"identical":true' || fail "the replay differs"
echo "haptic_run_test: $(cat "$work/samples.out"); flooded with $flooded packets; $heard poses by OpenIGTLink; $(cat "$work/client.out")"
