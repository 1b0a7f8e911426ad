// The way to the server: the token of the address, requests, and what changes as it changes.

const address = new URL(location.href);
const given = address.searchParams.get("token");
if (given) {
  sessionStorage.setItem("token", given);
  address.searchParams.delete("token");
  history.replaceState(null, "", address);
}
const token = sessionStorage.getItem("token") || "";

// What the server answers; an Error with its words if it refuses.
export async function post(path, body, binary = false) {
  let answer;
  try {
    answer = await fetch(path, {
      method: "POST", headers: { authorization: `Bearer ${token}` },
      body: body === undefined || body instanceof Blob ? body : JSON.stringify(body) });
  } catch {
    throw new Error("the server does not answer");
  }
  const kind = answer.headers.get("content-type") || "";
  const said = kind.startsWith("application/json") ? await answer.json()
    : binary && answer.ok ? await answer.blob() : await answer.text();
  if (!answer.ok) throw new Error(said.errors ? said.errors.join("\n") : said);
  return said;
}

// Calls hear(message) with each message, tell(words, good) when the connection comes and goes.
export function live(hear, tell) {
  const WAITS = [0.5, 1, 2, 5]; // [s] before each new try
  let tries = 0;
  const connect = () => {
    const line = new WebSocket(`${location.origin.replace("http", "ws")}/live`);
    line.onopen = () => line.send(token);
    line.onmessage = (event) => {
      if (tries !== -1) tell("connected", true);
      tries = -1;
      hear(JSON.parse(event.data));
    };
    line.onclose = (event) => {
      const wrong = event.code === 1008 || !token;
      tell(wrong ? "no entry: open the address that the server printed" : "the server is away", false);
      tries = Math.min(tries + 1, WAITS.length - 1);
      if (!wrong) setTimeout(connect, 1000 * WAITS[tries]);
    };
  };
  connect();
}

export function download(name, data) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(data);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export const part = (id) => document.getElementById(id);

// An element with words, and what else it has.
export function made(tag, words = "", more = {}) {
  const node = document.createElement(tag);
  node.textContent = words;
  for (const [key, value] of Object.entries(more)) {
    if (key in node) node[key] = value; else node.setAttribute(key, value);
  }
  return node;
}
