// All alarms, and the last that went.
import { alarmCard, fillCard, formerly } from "./alarm_card.js";
import { list, make, say } from "./dom.js";

export function fillAlarmList(dialog, alarms, over, time) {
  dialog.querySelector(".none").hidden = alarms.length > 0;
  list(dialog.querySelector(".now"), alarms, (alarm) => alarm.id, () => {
    const item = make("li");
    item.append(alarmCard());
    return item;
  }, (item, alarm) => {
    item.firstChild.dataset.key = alarm.id;
    fillCard(item.firstChild, alarm, time);
  });
  dialog.querySelector(".before").hidden = over.length === 0;
  list(dialog.querySelector(".over"), over, ({ id, until }) => `${id} ${until}`, () => make("li"), (item, one) => say(item, formerly(one)));
}
