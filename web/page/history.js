// Undo and redo: states of the page, as `read` gives them and `write` brings them back.

import { byId } from "./dom.js";

export class History {
  // `write` may promise. `changed` hears of each state that is reached.
  constructor(read, write, changed = () => {}) {
    Object.assign(this, { read, write, changed });
    this.forget();
    byId("undo").addEventListener("click", () => this.undo());
    byId("redo").addEventListener("click", () => this.redo());
    // A text that is being typed has an undo of its own.
    let typed = null;
    addEventListener("input", ({ target }) => { typed = target.matches("input:not([type=range], [type=checkbox])") ? target : null; });
    addEventListener("change", () => { typed = null; });
    addEventListener("keydown", (event) => {
      const key = event.key.toLowerCase();
      if (!(event.ctrlKey || event.metaKey) || !["z", "y"].includes(key) || (typed && event.target === typed)) return;
      event.preventDefault();
      if (key === "y" || event.shiftKey) this.redo();
      else this.undo();
    });
  }

  // What was before is of another input.
  forget() {
    [this.past, this.future, this.now, this.busy] = [[], [], null, false];
    this.show();
  }

  show() {
    byId("undo").disabled = this.past.length === 0;
    byId("redo").disabled = this.future.length === 0;
  }

  // Takes down a state that has come to rest, if it is another one.
  note() {
    if (this.busy) return;
    const state = this.read();
    if (state === null) return;
    const isNew = JSON.stringify(state) !== JSON.stringify(this.now);
    if (isNew && this.now !== null) {
      this.past.push(this.now);
      this.future = [];
    }
    this.now = state;
    this.show();
    this.changed(state);
  }

  // Notes what changes while it is moved once it has come to rest.
  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.note(), 300);
  }

  undo() {
    return this.go(this.past, this.future);
  }

  redo() {
    return this.go(this.future, this.past);
  }

  async go(from, to) {
    if (this.busy || from.length === 0) return;
    // What has not come to rest yet is undone with what was before it.
    const { now } = this;
    const state = from.pop();
    to.push(now);
    this.now = state;
    this.show();
    this.busy = true;
    try {
      await this.write(state, now);
    } finally {
      this.busy = false;
      this.changed(state);
    }
  }
}
