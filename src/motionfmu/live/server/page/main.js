// The page's link to the machine: the token goes first, then requests; frames come by themselves.
const token = new URLSearchParams(location.search).get("token") ?? "";
const socket = new WebSocket(`ws://${location.host}/live`);
socket.onopen = () => socket.send(token);
socket.onmessage = (event) => {
  if (typeof event.data !== "string") return;
  const got = JSON.parse(event.data);
  if (got.about) {
    document.querySelector("#name").textContent = got.about.name;
    socket.send(JSON.stringify({ do: "watch", with: { names: ["mcc.position"] } }));
  }
  if (got.frame) document.querySelector("#frame").textContent = JSON.stringify(got.frame, null, 1);
};
