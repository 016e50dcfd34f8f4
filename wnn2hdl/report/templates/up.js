(() => {
  // A page does not know which index leads to it; the index says so in its links. Only a page beside this one is followed.
  const path = new URLSearchParams(location.search).get("index") ?? "";
  if (!/^[^/:\\?#][^:\\?#]*\.html$/.test(path) || path.includes("//")) return;
  const link = document.querySelector("a.up");
  link.href = path.split("/").map(encodeURIComponent).join("/");
  link.hidden = false;
})();
