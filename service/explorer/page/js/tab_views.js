// What the tabs behind the first one show: fetched once the first numbers are seen, or as soon as one is opened.

import { DeviceView } from "./device_view.js";
import { DisksView } from "./disks_view.js";
import { FollowsView } from "./follows_view.js";
import { byId } from "./html.js";
import { LoadView } from "./load_view.js";
import { LocateView } from "./locate_view.js";
import { NetworkView } from "./network_view.js";
import { drawPath, pathText } from "./path_view.js";
import { PosesView } from "./poses_view.js";
import { ThreadsView } from "./threads_view.js";
import { SuccessView } from "./success_view.js";
import { TurnedPathView } from "./turned_path_view.js";

/** The views, which report what was chosen: a phase, a pose, a formation and the move to it, an observation, poses, a load, a device and a point of its path, a success map, a library or a thread. */
export function tabViews({ choosePhase, choosePose, chooseFormation, observe, measure, load, device, success, player, chooseLibrary, chooseThread }) {
  const deviceView = new DeviceView(device);
  return {
    load: new LoadView(load),
    device: deviceView,
    success: new SuccessView({ ...success, requestOfDevice: () => deviceView.request, fillDevice: (request) => deviceView.fillDevice(request) }),
    turned: new TurnedPathView(device.goTo, player),
    disks: new DisksView(byId("disks"), choosePhase),
    follows: new FollowsView(byId("follows"), chooseFormation),
    network: new NetworkView(
      byId("network"),
      (key) => chooseFormation(key, null),
      (text) => (byId("network-readout").textContent = text),
    ),
    locate: new LocateView(observe, choosePose),
    poses: new PosesView(measure, choosePose),
    threads: new ThreadsView(chooseLibrary, chooseThread),
    showPath: (path, isShown, chooseStep) => {
      byId("path-text").textContent = isShown ? pathText(path) : "";
      byId("path").replaceChildren();
      if (path) drawPath(byId("path"), path, chooseStep);
    },
  };
}
