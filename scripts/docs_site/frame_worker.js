// Browsers start no workers from files. A page that was opened as one searches in a hidden frame instead.
"use strict";

class FrameWorker extends EventTarget {
  constructor(address) {
    super();
    this.waiting = [];
    this.frame = document.createElement("iframe");
    this.frame.hidden = true;
    document.body.append(this.frame);
    const inside = this.frame.contentWindow;
    inside.postMessage = (data) => this.onmessage?.(new MessageEvent("message", { data }));
    const script = inside.document.createElement("script");
    script.src = new URL(address, document.baseURI);
    script.onload = () => {
      for (const data of this.waiting) this.deliver(data);
      this.waiting = null;
    };
    script.onerror = (event) => this.onerror?.(event);
    inside.document.head.append(script);
  }

  postMessage(data) {
    if (this.waiting) this.waiting.push(data);
    else this.deliver(data);
  }

  deliver(data) {
    // As a worker would, later, and on a copy.
    setTimeout(() => this.frame.contentWindow?.onmessage?.(new MessageEvent("message", { data: structuredClone(data) })));
  }

  terminate() {
    this.frame.remove();
  }
}

if (location.protocol === "file:") window.Worker = FrameWorker;
