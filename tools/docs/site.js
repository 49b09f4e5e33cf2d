// Typesets the formulas of each page, also after a search result opened it.
document$.subscribe(({ body }) => {
  for (const formula of body.querySelectorAll(".arithmatex")) {
    const display = formula.textContent.startsWith("\\[");
    const text = formula.textContent.replace(/^\\[([]|\\[)\]]$/g, "");
    katex.render(text, formula, { displayMode: display, throwOnError: true });
  }
});
