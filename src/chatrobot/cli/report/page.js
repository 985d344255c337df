const body = document.querySelector("tbody");
const heads = [...document.querySelectorAll("thead th")];
const key = (row, column) => row.cells[column].dataset.value ?? row.cells[column].textContent;
const isNumber = (column) => heads[column].classList.contains("n");

function compare(a, b, column, sign) {
  const [one, other] = [key(a, column), key(b, column)];
  if (one === "" || other === "") return (one === "") - (other === "");
  return sign * (isNumber(column) ? Number(one) - Number(other) : one.localeCompare(other));
}

heads.forEach((head, column) => {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = head.textContent;
  head.replaceChildren(button);
  button.addEventListener("click", () => {
    const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    heads.forEach((each) => each.removeAttribute("aria-sort"));
    head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    body.append(...[...body.rows].sort((a, b) => compare(a, b, column, sign)));
  });
});
