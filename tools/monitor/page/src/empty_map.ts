import { element } from "./dom";
import type { Status } from "./status";

// What is waited for while there is no map, and which command starts it.
function text(status: Status | null): string {
  if (!status || status.waiting) {
    return `<b>No pipeline is running</b><p>Start one, and it shows here:</p>
      <code>evit run --log LOG --map MAP --rig RIG</code>
      <code>evit up evit.procman replay</code>
      <code>scripts/demo --watch</code>`;
  }
  if (status.services.length === 0) {
    return `<b>Waiting for services</b><p>None has been heard on the bus. On a robot, start them with</p>
      <code>evit up evit.procman robot</code>`;
  }
  return `<b>Waiting for the map</b><p>It comes with map_server's answers, once the tracker has a pose.
    To see all of it now, start the monitor with</p><code>evit monitor --map FILE</code>`;
}

export function showEmptyMap(empty: boolean, status: Status | null): void {
  const place = element("map-empty");
  const html = empty ? text(status) : "";
  if (place.dataset.shown === html) return;
  place.dataset.shown = html;
  place.innerHTML = html;
}
