// Typesets the formulas of the page. One that KaTeX cannot read is shown as its text, in red.
for (const formula of document.querySelectorAll(".arithmatex")) {
  const text = formula.textContent;
  katex.render(text.replace(/^\\[([]|\\[)\]]$/g, ""), formula, {
    displayMode: text.startsWith("\\["),
    throwOnError: false,
  });
}
