// Elements of the page, and what lies in it packed.

export const byId = (id) => document.getElementById(id);

export function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

// A name of a file with what is not seen escaped, as marks that turn the direction of letters: as `walpha_base::shown` does.
export const shown = (name) => name.replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{DI}]/gu, (c) => `\\u{${c.codePointAt(0).toString(16)}}`);

// The value of a control, and those of several by their names.
export const valueOf = (control) => (control.type === "checkbox" ? control.checked : control.value);
export const valuesOf = (controls) => Object.fromEntries(controls.map((control) => [control.id, valueOf(control)]));

export function setValue(control, value) {
  if (control.type === "checkbox") control.checked = value;
  else control.value = value;
}

// Fills a table with names and values.
export function rows(table, facts) {
  table.replaceChildren(...facts.map(([name, value]) =>
    element("tr", {}, element("th", { textContent: name }), element("td", {}, value))));
}

// Lists a remark, once.
export function remark(text) {
  const known = [...byId("remarks").children].some((item) => item.textContent === text.trim());
  if (!known) byId("remarks").append(element("li", { textContent: text.trim() }));
}

export function download(bytes, name) {
  const link = element("a", { href: URL.createObjectURL(new Blob([bytes])), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// The bytes in an element: gzip, as base64.
export async function unpacked(id) {
  const text = atob(byId(id).textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

// The button that shows the notices of what is in the page.
export function showNotices() {
  byId("show-notices").addEventListener("click", async () => {
    const text = byId("notices-text");
    text.textContent ||= new TextDecoder().decode(await unpacked("notices"));
    text.hidden = !text.hidden;
  });
}
