// The way to the machine: the token goes first, then requests; frames and samples come by themselves.

const address = new URL(location.href);
const given = address.searchParams.get("token");
if (given) {
  sessionStorage.setItem("token", given);
  address.searchParams.delete("token");
  history.replaceState(null, "", address);
}
const token = sessionStorage.getItem("token") || "";

const heard = new Map(); // by kind of message: who wants it
const waiting = new Map(); // by number of a request: its promise
let socket = null, number = 0;
let coming = null; // a message whose bytes come next

export const on = (kind, hear) => heard.set(kind, [...(heard.get(kind) ?? []), hear]);
const tell = (kind, ...what) => (heard.get(kind) ?? []).forEach((hear) => hear(...what));

// The answer of a request; an Error with the machine's words if it is refused.
export function ask(name, more = {}) {
  if (socket?.readyState !== WebSocket.OPEN) return Promise.reject(new Error("the machine is away"));
  const id = ++number;
  socket.send(JSON.stringify({ id, do: name, with: more }));
  return new Promise((done, fail) => waiting.set(id, { done, fail }));
}

// The same for what a person does: a refusal is shown.
export function act(name, more = {}) {
  return ask(name, more).then((value) => { tell("done", name, more); return value; },
    (error) => { tell("refused", error.message); });
}

export async function fetched(path) {
  const answer = await fetch(path, { headers: { authorization: `Bearer ${token}` } });
  if (!answer.ok) throw new Error((await answer.json().catch(() => ({}))).error ?? answer.statusText);
  return answer;
}

function hear(event) {
  if (typeof event.data !== "string") {
    if (coming) tell(coming.kind, coming.about, new Float64Array(event.data));
    coming = null;
    return;
  }
  const got = JSON.parse(event.data);
  if ("id" in got) {
    const asked = waiting.get(got.id);
    waiting.delete(got.id);
    if (!asked) return;
    if ("error" in got) asked.fail(new Error(got.error)); else asked.done(got.value);
    return;
  }
  for (const [kind, about] of Object.entries(got)) {
    if (kind === "samples" || kind === "triggered") coming = { kind, about };
    else tell(kind, about);
  }
}

// Connect, and again whenever the line is cut; "link" tells (words, good).
export function connect() {
  const WAITS = [0.5, 1, 2, 5]; // [s] before each new try
  let tries = 0, ended = "";
  on("ended", (why) => { ended = why; });
  const next = () => {
    socket = new WebSocket(`${location.origin.replace("http", "ws")}/live`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => { socket.send(token); tries = 0; };
    socket.onmessage = hear;
    socket.onclose = (event) => {
      waiting.forEach(({ fail }) => fail(new Error("the line to the machine is cut")));
      waiting.clear();
      coming = null;
      const wrong = event.code === 1008 || !token;
      const words = wrong ? "no entry: open the address that the command printed"
        : ended || "the machine is away";
      tell("link", words, false);
      if (!wrong) setTimeout(next, 1000 * WAITS[Math.min(tries++, WAITS.length - 1)]);
    };
  };
  next();
}
