(() => {
  const root = document.documentElement, button = document.querySelector(".theme");
  const system = matchMedia("(prefers-color-scheme: dark)");
  // A page opened from disk may not be allowed to remember anything.
  const keep = (value) => { try { localStorage.setItem("wnn2hdl-theme", value); } catch { /* not remembered */ } };
  const kept = () => { try { return localStorage.getItem("wnn2hdl-theme"); } catch { return null; } };
  const dark = () => (root.dataset.theme ? root.dataset.theme === "dark" : system.matches);
  const show = () => { button.textContent = dark() ? "Light theme" : "Dark theme"; };
  if (["light", "dark"].includes(kept())) root.dataset.theme = kept();
  button.hidden = false;
  button.addEventListener("click", () => { root.dataset.theme = dark() ? "light" : "dark"; keep(root.dataset.theme); show(); });
  system.addEventListener("change", show);
  show();
})();
