'use strict';
(() => {
const $ = id => document.getElementById(id);
const cases = JSON.parse($('p-data').textContent);
if (!cases.length) return;
const AHEAD_S = 60, NO_TIME = -9999999, TICK_MS = 40;
const sum = (list, unit) => { let s = 0; return list.map(d => (s += d) / unit); };
for (const c of cases) {
  for (const s of c.ships) {
    s.hull = s.hull.map(p => p.map(v => v / 100));
    s.north = sum(s.north, 10); s.east = sum(s.east, 10);
    s.psi = sum(s.psi, 10); s.cog = sum(s.cog, 10); s.sog = sum(s.sog, 100);
  }
  for (const p of c.pairs) {
    p.range = sum(p.range, 10);
    p.tcpa = sum(p.tcpa, 1).map(v => v === NO_TIME ? null : v / 10);
    p.dcpa = sum(p.dcpa, 10);
  }
  c.order_course = sum(c.order_course, 10); c.order_speed = sum(c.order_speed, 100);
  c.route = c.route.map(p => p.map(v => v / 10));
  c.hazards = c.hazards.map(h => h.map(p => p.map(v => v / 10)));
}
let now = cases[0], t = 0, playing = null, ink = {};
const rad = deg => deg * Math.PI / 180;
const at = (list, x) => {
  const k = Math.min(Math.floor(x), list.length - 1), next = Math.min(k + 1, list.length - 1);
  return list[k] + (list[next] - list[k]) * (x - k);
};
const turn = (list, x) => {
  const k = Math.min(Math.floor(x), list.length - 1), next = Math.min(k + 1, list.length - 1);
  const d = ((list[next] - list[k] + 540) % 360 + 360) % 360 - 180;
  return list[k] + d * (x - k);
};
const pose = (s, x) => {
  const cog = rad(turn(s.cog, x)), sog = at(s.sog, x);
  return { n: at(s.north, x), e: at(s.east, x), psi: rad(turn(s.psi, x)), sog,
    vn: sog * Math.cos(cog), ve: sog * Math.sin(cog) };
};
const fixed = (v, d) => v === null || !Number.isFinite(v) ? '–' : v.toFixed(d).replace('-',
  '\u2212');
const deg360 = v => ((v % 360) + 360) % 360;
const time = k => Math.min(k * now.sample_s, now.last_s);
// The place of the moment among the samples; the last two may be closer than the others.
const sample = () => {
  const last = now.ships[0].north.length - 1, x = t / now.sample_s, from = time(last - 1);
  if (x <= last - 1) return x;
  return Math.min(last - 1 + (t - from) / (now.last_s - from), last);
};

function themed() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ['paper', 'text', 'muted', 'grid', 'own', 'target', 'fail', 'warn', 'good',
    'nominal'])
    ink[name] = style.getPropertyValue('--' + name).trim();
}
function canvas(id, heightOf) {
  const el = $(id), dots = window.devicePixelRatio || 1;
  const width = el.clientWidth || 480, height = Math.round(heightOf(width));
  el.style.height = height + 'px';
  if (el.width !== Math.round(width * dots) || el.height !== Math.round(height * dots)) {
    el.width = Math.round(width * dots); el.height = Math.round(height * dots);
  }
  const g = el.getContext('2d');
  g.setTransform(dots, 0, 0, dots, 0, 0);
  g.clearRect(0, 0, width, height);
  g.font = '12px "Seatrial Sans",sans-serif';
  return { g, width, height };
}
function path(g, points, close) {
  g.beginPath();
  points.forEach((p, i) => i ? g.lineTo(p[0], p[1]) : g.moveTo(p[0], p[1]));
  if (close) g.closePath();
}
function line(g, points, colour, width, dash) {
  g.strokeStyle = colour; g.lineWidth = width; g.setLineDash(dash || []); path(g, points);
  g.stroke();
  g.setLineDash([]);
}

function drawMap() {
  const { g, width, height } = canvas('p-map', width => width), x = sample();
  const poses = now.ships.map(s => pose(s, x)), own = poses[0], across = Number($('p-view').value);
  let n = own.n, e = own.e, scale;
  if (across) scale = width / across;
  else {
    const ns = now.ships.flatMap(s => s.north), es = now.ships.flatMap(s => s.east);
    for (const side of [-now.safety_m, now.safety_m]) { ns.push(own.n + side);
    es.push(own.e + side); }
    const low = [Math.min(...ns), Math.min(...es)], high = [Math.max(...ns), Math.max(...es)];
    n = (low[0] + high[0]) / 2; e = (low[1] + high[1]) / 2;
    const size = Math.max(high[0] - low[0], high[1] - low[1], 2 * now.safety_m, 50);
    scale = width / (size * 1.12);
  }
  const px = (pn, pe) => [width / 2 + (pe - e) * scale, height / 2 - (pn - n) * scale];
  const body = (s, p) => s.hull.map(([f, r]) => px(
    p.n + f * Math.cos(p.psi) - r * Math.sin(p.psi), p.e + f * Math.sin(p.psi) + r *
      Math.cos(p.psi)));
  g.fillStyle = ink.muted;
  for (const h of now.hazards) { path(g, h.map(p => px(p[0], p[1])), true); g.globalAlpha = .4;
  g.fill(); g.globalAlpha = 1; }
  const start = [now.ships[0].north[0], now.ships[0].east[0]];
  line(g, [start, ...now.route].map(p => px(p[0], p[1])), ink.grid, 1.5);
  now.pairs.forEach((pair, i) => cone(g, px, scale, own, poses[i + 1], pair.obstacle_m, width +
    height));
  g.globalAlpha = .13; g.lineJoin = 'round';
  if (now.distance === 'hull') {
    g.strokeStyle = ink.own; g.lineWidth = 2 * now.safety_m * scale;
    path(g, body(now.ships[0], own), true); g.stroke();
  } else {
    const c = px(own.n, own.e); g.fillStyle = ink.own; g.beginPath();
    g.arc(c[0], c[1], now.safety_m * scale, 0, 2 * Math.PI); g.fill();
  }
  g.globalAlpha = 1; g.lineJoin = 'miter';
  now.ships.forEach((s, i) => {
    const all = s.north.map((v, k) => px(v, s.east[k])), k = Math.floor(x) + 1;
    const colour = i ? ink.target : ink.own;
    g.globalAlpha = .3; line(g, all, colour, 1); g.globalAlpha = 1;
    line(g, all.slice(0, k), colour, 2);
  });
  now.pairs.forEach((pair, i) => {
    const k = Math.floor(x), tcpa = pair.tcpa[Math.min(k, pair.tcpa.length - 1)];
    if (tcpa === null || tcpa <= 0) return;
    const ends = [own, poses[i + 1]].map(p => px(p.n + p.vn * tcpa, p.e + p.ve * tcpa));
    line(g, ends, ink.warn, 1, [3, 3]);
    for (const p of ends) { g.strokeStyle = ink.warn; g.lineWidth = 1.5; g.beginPath();
    g.arc(p[0], p[1], 4, 0, 2 * Math.PI); g.stroke(); }
  });
  now.ships.forEach((s, i) => {
    const p = poses[i], colour = i ? ink.target : ink.own, c = px(p.n, p.e);
    line(g, [c, px(p.n + p.vn * AHEAD_S, p.e + p.ve * AHEAD_S)], colour, 1.2, [6, 3]);
    path(g, body(s, p), true); g.fillStyle = colour; g.fill();
    g.beginPath(); g.arc(c[0], c[1], 2, 0, 2 * Math.PI); g.fill();
    // names on four sides, since ships that meet are close to one another
    const name = i ? (now.ships.length > 2 ? 'target ' + i : 'target') : 'own';
    g.textAlign = i % 4 < 2 ? 'left' : 'right';
    g.fillText(name, c[0] + (i % 4 < 2 ? 7 : -7), c[1] + (i % 4 % 3 ? -7 : 16));
    g.textAlign = 'left';
  });
  bar(g, height, scale, width); sentence(g, width);
}
// Own velocities that lead into the disc: apex at the target's velocity, around the line of sight.
function cone(g, px, scale, own, target, radius, far) {
  if (radius === null || radius === undefined) return;
  const dn = target.n - own.n, de = target.e - own.e, d = Math.hypot(dn, de);
  const half = d > radius ? Math.asin(radius / d) : Math.PI / 2, sight = Math.atan2(de, dn);
  const apex = px(own.n + target.vn * AHEAD_S, own.e + target.ve * AHEAD_S), edge = [-1,
    1].map(s => {
    const a = sight + s * half; return [apex[0] + far * Math.sin(a), apex[1] - far * Math.cos(a)];
  });
  g.globalAlpha = .12; g.fillStyle = ink.fail; path(g, [edge[0], apex, edge[1]], true); g.fill();
  g.globalAlpha = .7; line(g, [edge[0], apex, edge[1]], ink.fail, 1); g.globalAlpha = .35;
  const c = px(target.n, target.e); g.strokeStyle = ink.target; g.lineWidth = 1;
  g.beginPath(); g.arc(c[0], c[1], radius * scale, 0, 2 * Math.PI); g.stroke(); g.globalAlpha = 1;
}
function bar(g, height, scale, width) {
  const round = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000].find(m => m *
    scale > width / 8) || 20000;
  line(g, [[14, height - 14], [14 + round * scale, height - 14]], ink.text, 2);
  g.fillStyle = ink.text; g.fillText(round + ' m', 14, height - 20);
  line(g, [[width - 18, 34], [width - 18, 12]], ink.text, 2); g.fillText('N', width - 22, 48);
}
function sentence(g, width) {
  const mark = now.marks.filter(m => m.t <= t && t - m.t < 15).pop();
  if (!mark) return;
  const words = mark.text.split(' '), lines = [''];
  for (const w of words) {
    const last = lines[lines.length - 1];
    if (g.measureText(last + ' ' + w).width > width - 60 && last) lines.push(w);
    else lines[lines.length - 1] = last ? last + ' ' + w : w;
  }
  g.fillStyle = ink.paper; g.globalAlpha = .85;
  g.fillRect(6, 6, width - 44, 16 * lines.length + 8); g.globalAlpha = 1;
  g.fillStyle = mark.bad ? ink.fail : ink.text;
  lines.forEach((text, i) => g.fillText(text, 12, 22 + 16 * i));
}

const TOP = 36, LANE = 16, CHART_MIN = 90;
const near = (v, other) => other + ((v - other + 540) % 360 + 360) % 360 - 180;
// Own courses without a jump at north, or by the compass where she spins; orders beside them.
function courses() {
  let last = now.ships[0].cog[0];
  let course = now.ships[0].cog.map(v => last = near(v, last));
  if (Math.max(...course) - Math.min(...course) > 720) course = course.map(deg360);
  const order = now.order_course.map((v, k) => near(v, course[Math.min(k, course.length - 1)]));
  return [course, order];
}
function drawCharts() {
  const lanes = now.lanes.length + now.pairs.length, below = lanes * LANE + 12;
  const wanted = width => Math.max(width * 1.16, TOP + 3 * (CHART_MIN + 28) + below);
  const { g, width, height } = canvas('p-charts', wanted);
  const left = 46, right = width - 12, high = (height - TOP - below) / 3 - 28;
  const x = s => left + (right - left) * s / Math.max(now.end_s, now.sample_s);
  const timed = list => list.map((v, k) => [time(k), v]);
  let top = TOP;
  const chart = (title, curves, low, limit, level, jump = Infinity) => {
    const y = v => top + high - high * (v - low) / (limit - low || 1);
    g.strokeStyle = ink.grid; g.lineWidth = 1; g.strokeRect(left, top, right - left, high);
    g.fillStyle = ink.text; g.fillText(title, left, top - 6);
    g.fillStyle = ink.muted; g.textAlign = 'right';
    g.fillText(fixed(limit, 0), left - 5, top + 9);
    g.fillText(fixed(low, 0), left - 5, top + high); g.textAlign = 'left';
    if (level !== undefined) line(g, [[left, y(level)], [right, y(level)]], ink.text, 1, [4, 4]);
    for (const [points, colour, dash] of curves) {
      let part = [];
      points.forEach((p, k) => {
        if (k && Math.abs(p[1] - points[k - 1][1]) > jump) {
          line(g, part, colour, 1.6, dash); part = [];
        }
        part.push([x(p[0]), y(p[1])]);
      });
      line(g, part, colour, 1.6, dash);
    }
    top += high + 28;
  };
  const ranges = now.pairs.map(p => p.range);
  const most = Math.max(now.safety_m, ...ranges.flat()) * 1.05;
  chart(now.distance === 'hull' ? 'distance between hulls, m' :
    'distance between reference points, m',
    ranges.map(r => [timed(r), ink.target]), 0, most, now.safety_m);
  const [course, order] = courses(), both = [...course, ...order];
  chart('own course, deg (dashed: ordered)', [[timed(order), ink.muted, [3, 3]], [timed(course),
    ink.own]], Math.min(...both) - 5, Math.max(...both) + 5, undefined, 180);
  const speeds = now.ships.map((s, i) => [timed(s.sog), i ? ink.target : ink.own]);
  chart('speed, m/s (dashed: ordered)', [[timed(now.order_speed), ink.muted, [3, 3]],
    ...speeds.reverse()], 0,
    Math.max(...now.ships.flatMap(s => s.sog), ...now.order_speed) * 1.1 + .1);
  top -= 14;
  const words = [];
  const band = (from, to, colour) => { if (to > from) { g.fillStyle = colour;
  g.fillRect(x(from), top, x(to) - x(from), LANE - 3); } };
  now.pairs.forEach((p, i) => {
    const end = p.released_s ?? now.end_s, starts = [p.risk_s, ...p.stages_s];
    band(0, now.end_s, ink.grid);
    starts.forEach((from, k) => { if (from !== null) { g.globalAlpha = .2 + .2 * k;
    band(from, end, ink.warn); g.globalAlpha = 1; } });
    words.push([(now.pairs.length > 1 ? 'target ' + (i + 1) + ': ' : '') + 'risk and stages, ' +
      p.class + (p.role ? ', ' + p.role : ''), top + 10]);
    top += LANE;
  });
  for (const l of now.lanes) {
    band(0, now.end_s, ink.grid);
    g.globalAlpha = .55; band(l.t ?? 0, now.end_s, ink[{ fail: 'fail', warn: 'warn',
      pass: 'good' }[l.status] || 'muted']); g.globalAlpha = 1;
    words.push([l.title + ': ' + l.status, top + 10]); top += LANE;
  }
  for (const m of now.marks) line(g, [[x(m.t), TOP], [x(m.t), top]], m.bad ? ink.fail :
    ink.nominal, 1, [2, 3]);
  line(g, [[x(t), 18], [x(t), top]], ink.text, 1.5);
  g.fillStyle = ink.text; g.lineJoin = 'round';
  for (const [text, y] of words) {
    g.strokeStyle = ink.paper; g.lineWidth = 3; g.strokeText(text, left + 4, y);
    g.fillText(text, left + 4, y);
  }
  g.lineJoin = 'miter';
  g.fillText(fixed(t, 1) + ' s', Math.max(left, Math.min(x(t) - 14, right - 46)), 13);
}

function readout() {
  const k = Math.floor(sample() + 1e-9), own = now.ships[0], rows = [['time', fixed(t, 1), 's',
    'p-now']];
  now.pairs.forEach((p, i) => {
    const n = now.pairs.length > 1 ? ' ' + (i + 1) : '', last = Math.min(k, p.range.length - 1);
    rows.push(['distance' + n, fixed(p.range[last], 1), 'm', 'p-range' + i]);
    rows.push(['predicted CPA' + n, fixed(p.dcpa[last], 0), 'm', 'p-dcpa' + i]);
    rows.push(['time to CPA' + n, fixed(p.tcpa[last], 0), 's', 'p-tcpa' + i]);
    rows.push(['state' + n, state(p), '', 'p-state' + i]);
  });
  rows.push(['own course', fixed(deg360(own.cog[k]), 1), 'deg', 'p-course'], ['own speed',
    fixed(own.sog[k], 2), 'm/s', 'p-speed-now']);
  $('p-readout').innerHTML = '';
  for (const [name, value, unit, id] of rows) {
    const cell = document.createElement('div'), dt = document.createElement('dt'),
      dd = document.createElement('dd');
    dt.textContent = unit ? name + ', ' + unit : name; dd.textContent = value; dd.id = id;
    cell.append(dt, dd); $('p-readout').append(cell);
  }
}
function state(p) {
  if (p.released_s !== null && t >= p.released_s) return 'past and clear';
  if (p.risk_s === null || t < p.risk_s) return 'no risk';
  let stage = 1;
  p.stages_s.forEach((s, i) => { if (s !== null && t >= s) stage = i + 2; });
  return p.class + ', stage ' + stage;
}
function draw() {
  drawMap(); drawCharts(); readout();
  $('p-time').value = t;
  $('p-link').href = '#id=' + encodeURIComponent(now.id) + '&t=' + t.toFixed(1);
  [...$('p-marks').children].forEach((li, i) => li.classList.toggle('now', now.marks[i].t <= t));
}
function select(c, from) {
  now = c; t = Math.min(Math.max(from, 0), c.end_s);
  $('p-id').value = c.id; $('p-time').max = c.end_s;
  $('p-marks').innerHTML = '';
  for (const m of c.marks) {
    const li = document.createElement('li'), a = document.createElement('a');
    a.textContent = fixed(m.t, 1) + ' s: ' + m.text;
    a.href = '#id=' + encodeURIComponent(c.id) + '&t=' + m.t.toFixed(1);
    if (m.bad) li.className = 'bad';
    li.append(a); $('p-marks').append(li);
  }
  draw();
}
function press(on) {
  clearInterval(playing); playing = null;
  if (on) {
    if (t >= now.end_s) t = 0;
    playing = setInterval(() => {
      t = Math.min(t + TICK_MS / 1000 * Number($('p-speed').value), now.end_s);
      if (t >= now.end_s) press(false);
      draw();
    }, TICK_MS);
  }
  $('p-play').textContent = playing ? 'Pause' : 'Play';
  $('p-play').setAttribute('aria-pressed', String(!!playing));
}
// `#id=head_on/000012&t=45`; `&press=play` presses the button, for the test in a browser.
function follow() {
  const asked = new URLSearchParams(location.hash.slice(1)), id = asked.get('id');
  const found = cases.find(c => c.id === id);
  if (!found) return;
  press(false); select(found, Number(asked.get('t')) || 0);
  $('player-title').scrollIntoView();
  if (asked.get('press') === 'play') $('p-play').click();
}
for (const c of cases) {
  const option = document.createElement('option');
  option.value = c.id; option.textContent = c.id + ' (' + c.outcome.replaceAll('_', ' ') + ')';
  $('p-id').append(option);
}
$('p-id').onchange = e => { press(false); select(cases.find(c => c.id === e.target.value), 0); };
$('p-play').onclick = () => press(!playing);
$('p-time').oninput = e => { press(false); t = Number(e.target.value); draw(); };
$('p-view').onchange = draw;
addEventListener('resize', draw);
addEventListener('hashchange', follow);
matchMedia('(prefers-color-scheme:dark)').addEventListener('change', () => { themed(); draw(); });
$('player').hidden = false;
themed(); select(cases[0], 0); follow();
document.fonts.ready.then(draw);
})();
