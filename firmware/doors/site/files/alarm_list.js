// All alarms, each with a link to what it means, and the last that went.
import { alarmCard, BOX_LOST, fillCard, formerly } from "./alarm_card.js";
import { attribute, list, make, mark, say, set } from "./dom.js";

export function fillAlarmList(dialog, alarms, over, time) {
  dialog.querySelector(".none").hidden = alarms.length > 0;
  list(dialog.querySelector(".now"), alarms, (alarm) => alarm.id, () => {
    const item = make("li"), card = alarmCard(), help = make("a.help", "Help");
    help.title = "What it means, and what to do";
    card.querySelector(".acts").append(help);
    item.append(card);
    return item;
  }, (item, alarm) => {
    const help = item.querySelector("a.help");
    mark(item.firstChild, "key", alarm.id);
    set(help, { hidden: alarm.id === BOX_LOST });
    attribute(help, "href", `/help#${alarm.id.split(":")[0]}`);
    fillCard(item.firstChild, { ...alarm, why: alarm.details || alarm.why }, time);
  });
  dialog.querySelector(".before").hidden = over.length === 0;
  list(dialog.querySelector(".over"), over, ({ id, until }) => `${id} ${until}`, () => make("li"), (item, one) => say(item, formerly(one)));
}
