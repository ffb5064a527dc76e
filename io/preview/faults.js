// The buttons that strike faults, folded by group. What no output of the camera can show says what it takes.

import { number } from "./plots.js";

const GROUPS = [[20, "Stream packets"], [30, "Frames"], [40, "Time stamps"], [50, "Control channel"], [60, "Device"], [70, "V4L2"],
  [80, "USB"], [256, "Picture"]];

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
// Words between backquotes are keys: set as such.
const sentence = text => text.split("`").map((part, i) => i % 2 ? make("code", {}, part) : part);

export class FaultBoard {
  // strike(fields): orders one by POST /fault; orderOf(): rate, value, frames, duration_s of the form.
  constructor(box, strike, orderOf) {
    Object.assign(this, { box, strike, orderOf, shown: {}, groups: [] });
  }
  build(faults) {
    let most = -1;
    for (const fault of faults) {
      if (fault.number >= most) {
        const [end, name] = GROUPS.find(([end]) => fault.number < end);
        most = end;
        const count = make("small"), details = make("details", {}, make("summary", {}, name, count));
        this.groups.push({ details, count, kinds: [] });
        this.box.append(details);
      }
      const group = this.groups.at(-1);
      group.details.append(this.row(fault));
      group.kinds.push(fault.kind);
    }
  }
  row(fault) {
    const kind = fault.kind, strikes = make("span", { className: "strikes" }), button = make("button", { type: "button" });
    button.addEventListener("click", () => this.strike(this.shown[kind].active ? { kind, rate: 0 } : { kind, ...this.orderOf() }));
    const row = make("div", { className: "fault", id: "fault-" + kind },
      make("span", { className: "name" }, kind.replaceAll("_", " ")), strikes, button, make("p", {}, ...sentence(fault.meaning)));
    if (fault.lacks) {
      row.classList.add("idle");
      row.append(make("p", { className: "lacks" }, `nothing here can show it: that takes ${fault.lacks}`));
    }
    this.shown[kind] = { row, strikes, button, active: false, lacks: fault.lacks };
    return row;
  }
  // newest: id of the newest frame. Gives how many are in force.
  show(faults, newest) {
    if (this.groups.length === 0) this.build(faults);
    for (const fault of faults) {
      const shown = this.shown[fault.kind], o = fault.order;
      shown.active = !!o && (!o.frames || newest < BigInt(o.from_frame) + BigInt(o.frames));
      shown.row.classList.toggle("active", shown.active);
      shown.button.textContent = shown.active ? "End" : "Strike";
      // What a scenario has ordered can be ended here, shown or not.
      shown.button.disabled = !!shown.lacks && !shown.active;
      shown.strikes.textContent = fault.strikes ? number(fault.strikes, 6) + " x" : "";
    }
    let all = 0;
    for (const { details, count, kinds } of this.groups) {
      const active = kinds.filter(kind => this.shown[kind].active).length, idle = kinds.filter(kind => this.shown[kind].lacks);
      all += active;
      const lacking = idle.length === kinds.length ? `, not without ${this.shown[idle[0]].lacks}` : "";
      count.textContent = `${kinds.length}${active ? `, ${active} in force` : ""}${lacking}`;
      details.classList.toggle("active", active > 0);
      details.classList.toggle("idle", idle.length === kinds.length && !active);
      // One that strikes is not hidden; who folds its group again is heard.
      if (active && !details.wasActive) details.open = true;
      details.wasActive = active > 0;
    }
    return all;
  }
}
