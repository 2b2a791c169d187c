// Figures have a tooltip, and boxes that scroll show whether there is more to the right. The tooltip shows the title of a
// shape in the group "hits" of a drawing, as the browser itself would after a delay. Arrow keys go from one shape to the
// next.
"use strict";
(() => {
  const tip = document.createElement("div");
  tip.id = "tip";
  tip.setAttribute("role", "tooltip");
  tip.hidden = true;
  document.body.append(tip);
  let chosen = null;

  const hide = () => {
    if (chosen) chosen.classList.remove("chosen");
    chosen = null;
    tip.hidden = true;
  };

  // Above the shape if there is room, below it otherwise.
  const moveTip = () => {
    if (!chosen) return;
    const at = chosen.getBoundingClientRect();
    const own = tip.getBoundingClientRect();
    const width = document.documentElement.clientWidth;
    const left = Math.min(Math.max(at.left + at.width / 2 - own.width / 2, 4), width - own.width - 4);
    const above = at.top - own.height - 8;
    tip.style.left = left + "px";
    tip.style.top = (above > 4 ? above : at.bottom + 8) + "px";
  };

  const show = (hit) => {
    if (hit === chosen) return;
    hide();
    chosen = hit;
    hit.classList.add("chosen");
    tip.textContent = hit.getAttribute("aria-label");
    tip.hidden = false;
    moveTip();
  };

  for (const group of document.querySelectorAll("svg .hits")) {
    const hits = [...group.children];
    hits.forEach((hit, index) => {
      // With the title, the browser would show a second tooltip.
      const title = hit.querySelector("title");
      const more = hit.dataset.page ? "\nclick: what happens in this job" : "";
      hit.setAttribute("aria-label", title.textContent + more);
      hit.setAttribute("role", "img");
      hit.setAttribute("tabindex", index ? "-1" : "0");
      title.remove();
    });
    const hitOf = (event) => {
      const hit = event.target.closest && event.target.closest(".hits > *");
      return hit && group.contains(hit) ? hit : null;
    };
    for (const kind of ["pointerover", "pointerdown", "focusin"]) {
      group.addEventListener(kind, (event) => { const hit = hitOf(event); if (hit) show(hit); });
    }
    group.addEventListener("pointerout", (event) => { if (event.pointerType !== "touch") hide(); });
    group.addEventListener("focusout", hide);
    // A mark may lead to a page of its own. The first touch shows the tooltip only.
    const open = (event) => {
      const hit = hitOf(event);
      if (hit && hit.dataset.page && !(event.pointerType === "touch" && hit !== touched)) location.href = hit.dataset.page;
    };
    let touched = null;
    let before = null;
    group.addEventListener("pointerdown", () => { touched = before; }, { capture: true });
    group.addEventListener("click", (event) => { open(event); before = hitOf(event); });
    group.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (event.key === "Escape") hide();
      if (event.key === "Enter") open(event);
      const next = step && hits[hits.indexOf(hitOf(event)) + step];
      if (!next) return;
      event.preventDefault();
      event.target.setAttribute("tabindex", "-1");
      next.setAttribute("tabindex", "0");
      next.focus();
    });
  }
  for (const box of document.querySelectorAll(".scroll")) {
    const markOverflow = () => box.classList.toggle("more", box.scrollLeft + box.clientWidth < box.scrollWidth - 2);
    box.addEventListener("scroll", markOverflow, { passive: true });
    new ResizeObserver(markOverflow).observe(box);
  }

  // Details are unfolded for printing.
  const folded = [];
  window.addEventListener("beforeprint", () => {
    for (const part of document.querySelectorAll("details:not([open])")) {
      part.open = true;
      folded.push(part);
    }
  });
  window.addEventListener("afterprint", () => { for (const part of folded.splice(0)) part.open = false; });

  document.addEventListener("pointerdown", (event) => { if (!event.target.closest(".hits")) hide(); });
  // A shape that gets the focus is scrolled into view, and the tooltip has to follow.
  document.addEventListener("scroll", moveTip, { capture: true, passive: true });
  window.addEventListener("resize", moveTip);
})();
