// Light or dark: as the reader chose last, else as the system is.
const root = document.documentElement;
const system = matchMedia("(prefers-color-scheme: dark)");
try { root.dataset.theme = localStorage.getItem("theme") ?? ""; } catch { /* no store: the system's */ }
const isDark = () => (root.dataset.theme ? root.dataset.theme === "dark" : system.matches);
