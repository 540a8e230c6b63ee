// SPDX-License-Identifier: Apache-2.0
// The search of all pages, and the list of a page's headings, which is open where it stands beside the text.
"use strict";

(() => {
  const root = document.documentElement.dataset.root;
  const form = document.querySelector("form[role=search]");
  const input = form.querySelector("input");
  const found = document.getElementById("found");
  const MOST = 30;  // places that are listed
  const AROUND = 70;  // characters of the text in front of the first word, and twice as many behind it

  const contents = document.querySelector(".contents details");
  if (contents) {
    const beside = matchMedia("(min-width: 90rem)");
    const follow = () => { contents.open = beside.matches; };
    beside.addEventListener("change", follow);
    follow();
  }

  // ---- Search ---------------------------------------------------------------------------------------------

  let places = null;  // what search_index.js has

  function load() {
    return places ??= new Promise((resolve, reject) => {
      const script = document.createElement("script");
      script.src = `${root}search_index.js`;
      script.onload = () => {
        const { pages, places: listed } = window.searchIndex;
        resolve(listed.map(([page, anchor, heading, text]) => ({
          address: root + pages[page][0] + (anchor && `#${anchor}`), page: pages[page][1], heading, text,
          sense: anchor.startsWith("word-"),  // a word of the glossary
          title: pages[page][1].toLowerCase(), head: heading.toLowerCase(), low: text.toLowerCase() })));
      };
      script.onerror = () => reject(new Error("search_index.js is missing"));
      document.head.append(script);
    });
  }

  const startsAt = (text, word) => text.startsWith(word) || [" ", "-", "_", "`", "(", ".", "/"].some((mark) => text.includes(mark + word));

  /** How well a place fits; 0 where a word is missing. */
  function score(place, words) {
    let sum = 0;
    for (const word of words) {
      const one = place.head === word ? 100 : startsAt(place.head, word) ? 40 : place.head.includes(word) ? 15 :
        startsAt(place.title, word) ? 12 : startsAt(place.low, word) ? 4 : place.low.includes(word) ? 1 : 0;
      if (one === 0) {
        return 0;
      }
      sum += one;
    }
    return place.head === words.join(" ") ? sum + (place.sense ? 150 : 100) : sum;
  }

  /** The text with the words marked. */
  function marked(text, words) {
    const element = document.createElement("span");
    const low = text.toLowerCase();
    let at = 0;
    while (at < text.length) {
      const next = words.map((word) => [low.indexOf(word, at), word.length]).filter(([place]) => place >= 0)
        .sort((one, two) => one[0] - two[0])[0];
      if (!next) {
        break;
      }
      const mark = document.createElement("mark");
      mark.textContent = text.slice(next[0], next[0] + next[1]);
      element.append(text.slice(at, next[0]), mark);
      at = next[0] + next[1];
    }
    element.append(text.slice(at));
    return element;
  }

  function excerpt(place, words) {
    const first = Math.min(...words.map((word) => place.low.indexOf(word)).filter((at) => at >= 0), Infinity);
    const from = first === Infinity ? 0 : Math.max(0, place.text.lastIndexOf(" ", Math.max(0, first - AROUND)));
    const text = place.text.slice(from, from + 3 * AROUND);
    return `${from > 0 ? "… " : ""}${text.trim()}${from + 3 * AROUND < place.text.length ? " …" : ""}`;
  }

  function shown(place, words) {
    const link = document.createElement("a");
    link.href = place.address;
    const title = document.createElement("strong");
    title.append(marked(place.heading || place.page, words));
    link.append(title);
    if (place.heading && place.heading !== place.page) {
      link.append(" ", Object.assign(document.createElement("small"), { textContent: place.page }));
    }
    const text = document.createElement("p");
    text.append(marked(excerpt(place, words), words));
    link.append(text);
    return link;
  }

  async function search() {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    found.hidden = words.length === 0;
    if (found.hidden) {
      return;
    }
    let listed;
    try {
      listed = (await load()).map((place) => [score(place, words), place]).filter(([points]) => points > 0);
    } catch (error) {
      found.replaceChildren(`The search cannot begin: ${error.message}.`);
      return;
    }
    listed.sort((one, two) => two[0] - one[0]);
    const count = document.createElement("p");
    count.textContent = listed.length === 0 ? `Nothing has "${input.value.trim()}".` :
      listed.length > MOST ? `The best ${MOST} of ${listed.length} places:` : `${listed.length} place${listed.length === 1 ? "" : "s"}:`;
    found.replaceChildren(count, ...listed.slice(0, MOST).map(([, place]) => shown(place, words)));
    found.scrollTop = 0;
  }

  function close() {
    found.hidden = true;
    input.blur();
  }

  form.hidden = false;
  input.addEventListener("input", search);
  input.addEventListener("focus", () => { load().catch(() => {}); search(); });
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    found.querySelector("a")?.click();
  });
  found.addEventListener("click", (event) => {
    if (event.target.closest("a")) {
      close();
    }
  });
  document.addEventListener("pointerdown", (event) => {
    if (!found.contains(event.target) && !form.contains(event.target)) {
      found.hidden = true;
    }
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      close();
    } else if (event.key === "/" && !event.target.closest("input, select, textarea")) {
      event.preventDefault();
      input.focus();
    }
  });
})();
