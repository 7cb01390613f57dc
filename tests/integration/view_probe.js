// Put into a page by view_test.py: moves a pointer over the picture, tries every coloring, and leaves
// what the page said in an attribute of its title.
const until = setInterval(() => {
  if (document.documentElement.dataset.state !== "ready") return;
  clearInterval(until);
  const heard = { titles: [], figures: {}, colors: [] };
  const canvas = document.getElementById("scene"), tip = document.getElementById("tip");
  const move = (x, y) => canvas.dispatchEvent(new PointerEvent("pointermove",
    { clientX: x, clientY: y, pointerType: "mouse", bubbles: true }));
  for (let y = 60; y < innerHeight - 60; y += 12) {
    for (let x = 60; x < innerWidth - 60; x += 12) {
      move(x, y);
      if (tip.hidden) continue;
      heard.figures[tip.querySelector("b").textContent] = Object.fromEntries(
        [...tip.querySelectorAll("tr")].map((row) => [...row.children].map((c) => c.textContent)));
    }
  }
  move(1, 1);
  heard.away = tip.hidden;
  const color = document.getElementById("color");
  for (const option of color.options) {
    color.value = option.value;
    color.dispatchEvent(new Event("input", { bubbles: true }));
    heard.colors.push([option.text, document.getElementById("least").textContent,
                       document.getElementById("ramp").hidden]);
  }
  document.getElementById("title").dataset.heard = JSON.stringify(heard);
}, 50);
