// What a reload finds again: the input and its state. The state is kept for this tab, and the bytes of the input in the browser's
// store, if they are not too many. Nothing leaves the machine.

const STATE = "walpha-state";
// Bytes of an input that are kept at most.
const MOST = 2 ** 26;
// Milliseconds after which bytes that another tab has left are deleted.
const OLD = 24 * 60 * 60 * 1000;

// A page from disk may have no store, and a store may be full: then nothing is found again.
const quiet = (work, otherwise) => {
  try {
    return work();
  } catch {
    return otherwise;
  }
};

const asked = (request) => new Promise((resolve, reject) => {
  request.onsuccess = () => resolve(request.result);
  request.onerror = () => reject(request.error);
});

async function inputs(mode) {
  const opening = indexedDB.open("walpha", 1);
  opening.onupgradeneeded = () => opening.result.createObjectStore("inputs");
  const base = await asked(opening);
  return base.transaction("inputs", mode).objectStore("inputs");
}

// The state that was kept, with the files of its input, or without them.
export async function restored() {
  const kept = quiet(() => JSON.parse(sessionStorage.getItem(STATE)), null);
  if (!kept?.input) return null;
  if (kept.isMade) return { ...kept, files: [] };
  try {
    const all = await inputs("readonly");
    const key = (await asked(all.getAllKeys())).find(([tab]) => tab === kept.tab);
    const found = key && await asked(all.get(key));
    return { ...kept, files: found?.input === kept.input ? found.files.map(({ path, bytes }) => ({ path, file: new File([bytes], path.replace(/^.*\//, "")) })) : null };
  } catch {
    return { ...kept, files: null };
  }
}

// Keeps an input: those made by the page are made again.
export async function keepInput(input, files, isMade) {
  const tab = quiet(() => JSON.parse(sessionStorage.getItem(STATE))?.tab, null) ?? crypto.randomUUID?.() ?? String(Math.random());
  quiet(() => sessionStorage.setItem(STATE, JSON.stringify({ tab, input, isMade, bytes: files.reduce((sum, { file }) => sum + file.size, 0) })));
  try {
    const fits = !isMade && files.reduce((sum, { file }) => sum + file.size, 0) <= MOST;
    const kept = fits ? await Promise.all(files.map(async ({ path, file }) => ({ path, bytes: await file.arrayBuffer() }))) : null;
    const all = await inputs("readwrite");
    for (const key of await asked(all.getAllKeys())) {
      const [of, time] = key;
      if (of === tab || Date.now() - time > OLD) all.delete(key);
    }
    if (kept) await asked(all.put({ input, files: kept }, [tab, Date.now()]));
  } catch {
    // It is chosen again after a reload.
  }
}

// Whether an input is being brought back: where that ends the page, it is not tried again.
export function restoring(isOn) {
  quiet(() => {
    const kept = JSON.parse(sessionStorage.getItem(STATE));
    if (kept) sessionStorage.setItem(STATE, JSON.stringify({ ...kept, failed: isOn }));
  });
}

export function keepState(state) {
  quiet(() => {
    const kept = JSON.parse(sessionStorage.getItem(STATE));
    if (kept) sessionStorage.setItem(STATE, JSON.stringify({ ...kept, state }));
  });
}
