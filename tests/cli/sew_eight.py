#!/usr/bin/python3
"""Writes a demonstration of anastomosis-8, stitch by stitch, each tried from the state that the one before ended in.

  sew_eight.py STATE.json [STITCHES]     (in an empty folder; FILUM_ROOT: the project, REHEARSAL: its build/tests/.../filum_rehearsal,
                                          TASK: another task of one stitch, or in which each stitch has a fresh suture and the clamp is turned on once;
                                          HINTS: a STATE.json of an earlier program, whose choices are tried first)

The hands are those of sew_eight_hands.yaml, moved along with the cut edges as they are seen when a stitch begins (keys `at: { edge: N }`), with some lengths
to choose. Several tries run at a time (TRIES=2); the first whose bites, then knot, are good is taken; where an earlier knot opens
in every try, that stitch is taken back and sewn otherwise. STATE.json holds what was found; from it the search goes on, and
does it all again first if the processes of filum_rehearsal sleep no more (a copy of sew_eight_found.json is a beginning); STATE.json.log tells each try. The script of all stitches found is STATE.json.yaml."""
import itertools, json, os, random, re, subprocess, sys, threading, time

ROOT = os.environ.get('FILUM_ROOT', '.')
REHEARSAL = os.environ.get('REHEARSAL', ROOT + '/build/tests/filum_rehearsal')
TRIES = int(os.environ.get('TRIES', '2'))
TASK = os.environ.get('TASK', 'anastomosis-8')
SECONDS = 91.0                                            # of the script, a stitch
HINTS = json.load(open(os.environ['HINTS']))['stitches'] if 'HINTS' in os.environ else []
BITES = ('aside', 'enter', 'leave', 'press', 'take')      # what is chosen before the knot
EDGES = ((0.0, -0.3127, 0.4489), (0.0, 0.3127, 0.4489))   # [mm], as the template's hands found them
FIRM = 0.55                                               # [mm], least tail of the knot just cut; it shortens while others are sewn beside it
SHORT = 0.25                                              # [mm], least short end: drawn in, a knot opens stitches later
WIDE, INNER = 0.66, 0.1                                   # [mm], most of an outer bite, least of an inner one
OPENED = 'an earlier knot opened'
PLACE = 21.0                                              # [degrees], most by which a stitch is beside its place


def of_scene(field, default=None):
    found = re.search(r'^ *%s: (.*)' % field, open('%s/curricula/%s/scene.yaml' % (ROOT, TASK)).read(), re.M)
    return found.group(1) if found else default


STITCHES = int(of_scene('sutures', '"1"').strip('"'))
LOOP = 2.95                                               # [mm], most of a knot's loop: one of 3.1 or 3.2 leaves joins that leak 11 to 21 ml/min
SLIDES = {8: (.7, .8, .9), 6: (.6, .8, .55)}.get(STITCHES, (.8, .9, 1.0))   # [s], of the clamp before a tie: fewer stitches leave more of the edge to itself

# Lengths in mm, times in s. aside: of needle and forceps from the middle (x), for what turned with the stitches before; enter, leave:
# of the needle beside the template's way, (y, z) from the first, the second edge; press: of the forceps on the second edge; take: where along the needle they take it; cut: of the ends from the knot; slide, last, open: how long the clamp slides before the tie, before
# the cuts, and open again; short: where the short end is cut, from its free end, for a strand that is not found from its knot (0: `cut` from the knot); let_go: where the short end is let go; first, firm [mN]: pulls at which the first and the second throw are drawn down
# (with 8 a knot may spring open stitches later)
DEFAULT = dict(aside=0, enter=(0, 0), leave=(0, 0), press=(0, 0), take=3.65, cut=1.0, short=0, slide=SLIDES[0], last=0.18, open=1.2, let_go=(0, -.25, -.4), first=10, firm=30)


def numbers(text): return [float(x) for x in re.findall(r'-?\d+\.?\d*', text)]


TURNS = numbers(of_scene('turns', '0 deg'))   # [degrees]; at 0 the vessel's 90 degrees lie on top


def read_template():
    """Keys of the first and of the second stitch, from when it begins; `p` as numbers, all else as text."""
    tracks, tool = {0: [], 1: [], 2: []}, 0
    for line in open(ROOT + '/tests/cli/sew_eight_hands.yaml'):
        tool = int(m.group(1)) if (m := re.match(r'\s+- tool: (\d)', line)) else tool
        if '{ t:' not in line: continue
        key = {'t': numbers(line)[0]}
        arc = re.search(r'arc: (\{.*?turns: [^}]*\})', line)
        key['arc'] = arc and arc.group(1)
        rest = line.replace('arc: ' + arc.group(1), '') if arc else line
        for name, pattern in (('at', r'\bat: (\{[^}]*\})'), ('p', r'\bp: \[("[^\]]*)\]'), ('handle', r'handle: (\[[^\]]*\])'), ('opening', r'opening: (\[[^\]]*\])'),
                              ('grip', r'grip: "([^"]*)"'), ('until', r'until: (\{[^}]*\})'), ('say', r'say: "([^"]*)"')):
            m = re.search(pattern, rest)
            key[name] = m and m.group(1)
        key['p'] = key['p'] and numbers(key['p'])
        key['stop'], key['buttons'] = 'stop: true' in rest, None
        tracks[tool].append(key)
    part = lambda a, b: {tool: [dict(k, t=k['t'] - a) for k in keys if a - 1e-6 <= k['t'] < b - 1e-6] for tool, keys in tracks.items()}
    return part(0.0, 90.093), part(90.093, 180.586)


def written(key):
    words = ['t: "%.3f s"' % key['t']]
    if key.get('at') is not None: words.append('at: ' + key['at'])
    if key.get('p'): words.append('p: ["%.4f mm", "%.4f mm", "%.4f mm"]' % tuple(key['p']))
    words += ['%s: %s' % (n, key[n]) for n in ('handle', 'opening', 'arc', 'until') if key.get(n)]
    if key.get('grip'): words.append('grip: "%s"' % key['grip'])
    if key.get('stop'): words.append('stop: true')
    if key.get('buttons'): words.append('buttons: [%s]' % key['buttons'])
    if key.get('say'): words.append('say: "%s"' % key['say'])
    return '      - { ' + ', '.join(words) + ' }'


def button(t, name=None, say=None): return dict(t=t, stop=True, buttons=name, say=say)


def drawn_down(key, p):
    for t, pull in ((52.693, 'first'), (75.393, 'firm')):
        if abs(key['t'] - t) < .01: key['until'] = '{ pull: "%g mN" }' % p[pull]


def beside(key, edge, move, aside):
    if key['p']: key['p'] = [key['p'][0] + aside, key['p'][1] - EDGES[edge][1] + move[0], key['p'][2] - EDGES[edge][2] + move[1]]


def holder(keys, p, relative):
    for key in keys:
        t = key['t']
        if relative and 6.65 < t < 20.5:
            edge = 0 if t < 11.45 else 1
            begins = abs(t - 6.7) < 0.05 or 11.45 < t < 11.6
            key['at'] = '{ edge: %d, bring: "0.50 mm" }' % edge if begins else None
            beside(key, edge, p['enter'] if edge == 0 else p['leave'], p['aside'])
        drawn_down(key, p)
        if abs(t - 40.293) < .01: key['buttons'] = 'cut'
        if abs(t - 54.593) < .01: key['p'] = [a + b for a, b in zip(key['p'], p['let_go'])]
    begins = next(key for key in keys if key['buttons'] == 'cut' and abs(key['t'] - 40.293) < .01)
    return keys + [dict(begins, t=40.293 + p['slide'], buttons=None, say=None)]


def forceps(keys, p, relative):
    for key in keys:
        t = key['t']
        drawn_down(key, p)
        if relative and 14.7 < t < 20.6:
            if t < 14.9: key['at'] = '{ edge: 1 }'
            beside(key, 1, p['press'], p['aside'])
        if relative and 21.1 < t < 21.2: key['at'] = '{}'
        if key['at'] and 'needle' in key['at'] and t < 25: key['at'] = '{ needle: "%.2f mm" }' % p['take']
    return keys


def scissors(keys, p, last_stitch):
    keys = [k for k in keys if k['t'] < 86]
    for key in keys:
        if key['at'] and 'knot' in key['at']:
            at_end = 'end' in key['at']
            key['at'] = '{ thread: "%.2f mm", from: end }' % p['short'] if at_end and p['short'] else '{ knot: "%.2f mm", from: %s }' % (p['cut'], 'end' if at_end else 'swage')
    keys += [button(72.002, 'cut'), button(72.02), button(72.042, 'cut', 'Edges together, gently'), button(72.06 + p['last'])]
    if last_stitch: return keys + [button(86.193), button(90.0)]
    return keys + [button(86.193, 'fresh', 'Ask for a fresh suture, and turn the clamp until the next place lies on top'), button(86.293), button(86.393, 'next'), button(86.493),
                   button(88.693, 'cut', 'Let the edges stand apart a little'), button(88.693 + p['open']), button(90.6)]


def stitch(k, parameters, last_stitch):
    p, template = dict(DEFAULT, **parameters), read_template()[min(k, 1)]
    tracks = {0: forceps(template[0], p, k > 0), 1: holder(template[1], p, k > 0), 2: scissors(template[2], p, last_stitch)}
    for keys in tracks.values():
        keys[:] = sorted((dict(key, t=key['t'] + k * SECONDS) for key in keys if key['t'] < SECONDS), key=lambda key: key['t'])
        if k > 0 and keys[0].get('p') and keys[0]['at'] is None: keys[0]['at'] = '{}'
    return tracks


def write(path, stitches):
    """One more stitch than are known, so that the hands are not done while the last one is looked at."""
    parts = [stitch(k, p, k + 1 == STITCHES) for k, p in enumerate(stitches + [{}] * (len(stitches) < STITCHES))]
    with open(path, 'w') as f:
        f.write('format: filum-demonstration/1\ntitle: %s\ntools:\n' % of_scene('title'))
        for tool in (0, 1, 2):
            f.write('  - tool: %d\n    keys:\n' % tool)
            last = -1.0
            for key in itertools.chain(*(part[tool] for part in parts)):
                last = key['t'] = max(key['t'], last + 0.001)
                f.write(written(key) + '\n')
    return path


def told(name):
    try: return [json.loads(line.replace('NaN', 'null')) for line in open(name + '.out') if line.startswith('{')]
    except OSError: return []


def failed(name):
    """What is wrong with the whole once all is sewn, or None."""
    result = next((s for s in told(name) if s['why'] == 'result'), None)
    return '%s' % result['verdict'] if result and not result['passed'] else None


def follow(name, check, given_up, pipe=None, order=None):
    """Sends the order and waits; the last state told and what is wrong with it, or None."""
    if os.path.exists(name + '.out'): os.remove(name + '.out')
    with open(pipe, 'w') as f: f.write(order + '\n')
    seen, ended = 0, False
    while True:
        text = open(name + '.out').read() if os.path.exists(name + '.out') else ''
        ended = text.endswith('done\n')
        states = [s for s in told(name) if s['why'] == 'stop']
        wrong = next((w for s in states[seen:] if (w := check(s))), None)
        seen = len(states)
        if 'stitch-out-of-turn' in text: wrong = wrong or 'out of turn'
        if wrong is None and ended and not states: wrong = text[-300:]
        if wrong is None and ended: wrong = failed(name)
        if wrong is None and given_up(): wrong = 'another was good'
        if wrong and not ended and (m := re.match(r'pid (\d+)', text)): subprocess.run(['kill', '-9', m.group(1)])
        if wrong or ended: return (states[-1] if states else None), wrong
        time.sleep(0.5)


def opened(k, s): return any(n['knot'] != 'square' for n in s['stitches'][:k])


def bites_wrong(k, s, tau):
    passes, drawn = s['passes'][2 * k:], tau > 30
    if opened(k, s): return OPENED
    if tau < 18: return None if passes and passes[0]['bites'][1] >= INNER and all(p['side'] != passes[0]['side'] for p in passes[1:]) else 'first wall %s' % [p['bites'] for p in passes]
    if len(passes) != 2 or not passes[1]['out']: return 'passes %s' % [(p['state'], p['side'], p['bites']) for p in passes]
    if min(passes[0]['bites'][1], passes[1]['bites'][0]) < INNER: return 'inner bites %s' % [p['bites'] for p in passes]
    if not drawn: return None if s['needle_held'][0] else 'forceps missed the needle'
    if any(p['state'] != 2 or p['torn'] for p in s['passes']): return 'torn, or not drawn through'
    if passes[0]['side'] == passes[1]['side'] or passes[0]['depths'][1] < .95 or passes[1]['depths'][0] < .95: return 'not through the wall'
    if max(passes[0]['bites'][0], passes[1]['bites'][1]) > WIDE: return 'wide %s' % [p['bites'] for p in passes]
    off = (s['stitches'][k]['angle'] - 90.0 + TURNS[k] + 180.0) % 360.0 - 180.0
    return 'beside its place by %.1f' % off if abs(off) > PLACE else None


def knot_wrong(k, s, tau):
    if opened(k, s): return OPENED
    square = [n for n in s['knots'] if n['class'] == 'square']
    if any(p['state'] != 2 or p['torn'] for p in s['passes']): return 'torn'
    if len(square) < k + (tau > 76) or (tau > 80 and any(n['knot'] != 'square' for n in s['stitches'])): return 'knots %s' % [(n['class'], n['loop']) for n in s['knots']]
    if tau < 55 or 70 < tau < 76: return None if s['thread_held'][1] else 'short end not held'
    if 55 < tau < 70: return None if any(n['class'] == 'overhand' for n in s['knots']) else 'first throw open'
    return 'loose or long %s' % [(n['loop'], n['tail']) for n in square] if tau > 80 and (square[-1]['tail'] < FIRM or square[-1]['short'] < SHORT or any(n['loop'] > LOOP or not 0.28 < n['tail'] < 2.0 for n in square)) else None


def race(tries, run, most, log):
    lock, good, count = threading.Lock(), [], itertools.count()
    def work():
        while True:
            with lock:
                n = next(count)
                if good or n >= most: return
                choice = next(tries)
            found, wrong = run(n, choice, lambda: bool(good))
            log(n, choice, wrong or 'good')
            with lock:
                if not wrong and not good: good.append(found)
    threads = [threading.Thread(target=work) for _ in range(TRIES)]
    for t in threads: t.start()
    for t in threads: t.join()
    return good[0] if good else None


def bite_choices(random_, k):
    """The first stitch lies some 14 degrees beside the middle: so does the second one then, to be across from it."""
    if k < len(HINTS): yield {name: value for name, value in HINTS[k].items() if name in BITES}
    usual = ((0, -.36), (.12, .06), .2), ((0, -.36), (.1, -.05), .2), ((0, -.36), (.2, .04), .2), ((.03, -.42), (.12, .06), .2), ((0, -.36), (.3, .1), .2), ((0, -.3), (.12, .06), .2)
    between = ((.14, -.5), (.2, .04), .2), ((.12, -.46), (.24, .04), .2), ((.05, -.42), (.2, .04), .2), ((.1, -.5), (.28, .0), .2), ((0, -.48), (.2, .04), .2), ((.05, -.3), (.2, .04), .2), ((.2, -.42), (.2, .04), .2), ((.12, -.42), (.2, .04), .2), ((.16, -.36), (.2, .04), .2)
    rolled = ((-.06, -.36), (.2, .04), .35), ((-.06, -.36), (.2, .04), .05), ((-.06, -.36), (.46, .02), .2), ((-.06, -.36), (.42, .1), .2), ((-.06, -.36), (.3, -.1), .2), ((-.06, -.36), (.3, .2), .2)  # an edge that went under between tight neighbours
    for enter, leave, press in rolled + between + usual if k > 5 else between + usual if k > 3 else usual:
        for aside in (.1, 0, .15) if k < 3 else (.05, -.05) if k > 5 else (.05, .09, 0): yield dict(aside=aside, enter=enter, leave=leave, press=(press, 0), take=3.7)
    while True:
        near = lambda a, b: round(random_.uniform(a, b), 3)
        yield dict(aside=random_.choice((0, .05, -.05, .1, -.1, .2, -.2)), enter=(near(-.05, .2), near(-.45, -.2)), leave=(near(.06, .3) if k < 4 else near(.1, .5), near(-.1, .12)), press=(near(.1, .25), near(-.05, .05)), take=random_.choice([3.6, 3.65, 3.7]))


def knot_choices(random_, k):
    """Before the ends of the last stitch are cut, the clamp comes as near as before each."""
    if k < len(HINTS): yield {name: value for name, value in HINTS[k].items() if name not in BITES}
    lasts = ((.8, .45) if STITCHES == 6 else (.18, .3, .45)) if k + 1 == STITCHES else (.18,)
    yield from (dict(slide=slide, let_go=let_go, first=first, firm=30, cut=cut, last=last) for last in lasts for cut in (1.7, 1.9)  # ends are drawn in by up to 1.3 mm while the clamp comes nearer
                for first in (10, 9) for let_go in ((0, -.3, -.45), (0, -.15, -.6), (0, -.5, -.3)) for slide in SLIDES)
    while True:
        yield dict(let_go=(0, round(random_.uniform(-.6, 0), 2), round(random_.uniform(-.8, 0), 2)), slide=round(random_.uniform(.7, 1.5) * SLIDES[0], 2), first=random_.choice([9, 10, 11]), firm=random_.choice([30, 45]), cut=random_.choice([1.5, 1.7, 1.9]),
                   last=random_.choice(lasts))


def sleeps(pipe):
    try: os.close(os.open(pipe, os.O_WRONLY | os.O_NONBLOCK))
    except OSError: return False
    return True


def do_again(state, file):
    end = len(state['stitches']) * SECONDS - 0.1
    script = write(file + '_again.yaml', state['stitches'])
    with open(file + '_again.out', 'w') as out: subprocess.run([REHEARSAL, ROOT, TASK, script, file + '_again', '%g' % (end + .05), '%g' % end], stdout=out, check=True)
    state['pipe'] = file + '_again_%.1f' % end


def take_back(state, log):
    if not state.get('pipes') or state['pipes'][-1] is None or not sleeps(state['pipes'][-1]): return False
    state.setdefault('avoid', []).append(state['stitches'].pop())
    state['pipe'] = state['pipes'].pop()
    log('stitch', len(state['stitches']) + 1, 'taken back')
    return True


def sew(state, file, random_, log):
    k, start = len(state['stitches']), len(state['stitches']) * SECONDS
    name = lambda kind, n: '%s_%d_%s%d_%d' % (file, k, kind, n, state['count'])
    def try_bites(n, choice, given_up):
        me = name('b', n)
        script = write(me + '.yaml', state['stitches'] + [choice])
        _, wrong = follow(me, lambda s: bites_wrong(k, s, s['t'] - start), given_up, state['pipe'], 'go %s %s %g %g %g %g' % (me, script, start + 38, start + 14.2, start + 24.2, start + 37.8))
        return (choice, '%s_%.1f' % (me, start + 37.8)), wrong
    ways, ties = bite_choices(random_, k), knot_choices(random_, k)
    wrongs = []
    def said(kind):
        def note(n, choice, wrong):
            wrongs.append(wrong)
            log(k, kind, n, choice, wrong)
        return note
    for _ in range(6):
        if len(wrongs) > 4 and k > 0 and all(w in (OPENED, 'another was good', 'good') for w in wrongs) and OPENED in wrongs: return take_back(state, log)
        state['count'] = state.get('count', 0) + 1
        if k == 0:
            script = write(file + '_first.yaml', [{}])
            with open(file + '_first.out', 'w') as out: subprocess.run([REHEARSAL, ROOT, TASK, script, file + '_first', '38', '37.8'], stdout=out, check=True)
            bites = ({}, file + '_first_37.8')
        else:
            bites = race(ways, try_bites, 10, said('bites'))
        if not bites: continue
        def try_knot(n, choice, given_up):
            me, chosen = name('k', n), dict(bites[0], **choice)
            if json.loads(json.dumps(chosen)) in state.get('avoid', []): return None, 'was taken back'
            script = write(me + '.yaml', state['stitches'] + [chosen])
            stops = ' '.join('%g' % (start + t) for t in (54.0, 60.0, 71.9, 76.4, 90.9 if k + 1 < STITCHES else 89.5))
            _, wrong = follow(me, lambda s: knot_wrong(k, s, s['t'] - start), given_up, bites[1], 'go %s %s %g %s' % (me, script, start + 90.95, stops))
            return (chosen, '%s_%.1f' % (me, start + 90.9)), wrong
        knot = race(ties, try_knot, 6, said('knot'))
        if knot:
            state['stitches'].append(json.loads(json.dumps(knot[0])))
            state.setdefault('pipes', []).append(state['pipe'])
            state['pipe'] = knot[1]
            return True
    return False


def main():
    file, wanted = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else STITCHES
    state = json.load(open(file)) if os.path.exists(file) else dict(stitches=[], pipe=None, count=0)
    journal = open(file + '.log', 'a')
    log = lambda *words: print(time.strftime('%H:%M:%S'), *words, file=journal, flush=True)
    random_ = random.Random(int(os.environ.get('SEED', '1')))
    if state['stitches'] and not sleeps(state.get('pipe') or ''): do_again(state, file)
    while len(state['stitches']) < wanted and sew(state, file, random_, log):
        json.dump(state, open(file, 'w'))
        write(file + '.yaml', state['stitches'])
        log('stitch', len(state['stitches']), state['stitches'][-1])
    return 0 if len(state['stitches']) >= wanted else 1


if __name__ == '__main__':
    sys.exit(main())
